#pragma once
/// Small parts that several estimators are made of. Private to estimation.

#include <string_view>

#include "pos/core/square.hpp"
#include "pos/estimation/estimator.hpp"

namespace pos::estimation {

/// The report on a measurement that changed nothing.
inline IngestReport refusal(Verdict verdict, std::string_view reason) {
  return {.verdict = verdict, .reason = reason};
}

/// Covariance of three like, independent components of standard deviation `sigma`.
inline Matrix<3, 3> diagonal3(double sigma) {
  return square(sigma) * Matrix<3, 3>::Identity();
}

}  // namespace pos::estimation
