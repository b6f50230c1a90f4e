#include "pos/core/chi_square.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace pos {

double chiSquareQuantile(double probability, double dof) {
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

double chiSquareProbability(double x, double dof) {
  return x <= 0.0 ? 0.0 : boost::math::cdf(boost::math::chi_squared(dof), x);
}

Interval meanChiSquareBounds(double confidence, double dof, double n) {
  const double tail = 0.5 * (1.0 - confidence);
  return {chiSquareQuantile(tail, dof * n) / n, chiSquareQuantile(1.0 - tail, dof * n) / n};
}

}  // namespace pos
