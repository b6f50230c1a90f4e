#include "pos/uwb/residual_test.hpp"

#include <limits>

#include "pos/core/chi_square.hpp"

namespace pos::uwb {

ResidualTest::ResidualTest(double significance) {
  for (std::size_t dof = 1; dof < threshold_.size(); ++dof) {
    threshold_[dof] = chiSquareQuantile(1.0 - significance, static_cast<double>(dof));
  }
}

ResidualTest ResidualTest::off() {
  ResidualTest test;
  test.threshold_.fill(std::numeric_limits<double>::infinity());
  return test;
}

}  // namespace pos::uwb
