#pragma once
/// What readings say of a place and of a mode. Private to `seamless`.

#include <algorithm>
#include <array>
#include <cmath>

#include "parts.hpp"
#include "pos/core/chi_square.hpp"

namespace pos::estimation {

inline constexpr double kUnsure = 1e3;  ///< m, sigma of a place that readings do not tell

/// 99.99 % of a chi-square variable stay below, by degrees of freedom.
inline double evidenceLimit(int dof) {
  static const std::array<double, 65> kLimits = [] {
    std::array<double, 65> all{};
    for (std::size_t n = 1; n < all.size(); ++n) all[n] = chiSquareQuantile(0.9999, static_cast<double>(n));
    return all;
  }();
  return kLimits[std::min<std::size_t>(static_cast<std::size_t>(dof), kLimits.size() - 1)];
}

inline double logDet(const Matrix<3, 3>& S) {
  return 2.0 * S.llt().matrixL().toDenseMatrix().diagonal().array().log().sum();
}

/// Covariance of the place that readings with this information give; kUnsure where they give none.
inline Matrix<3, 3> placeCovariance(const Matrix<3, 3>& information) {
  return (information + Matrix<3, 3>::Identity() / square(kUnsure)).inverse();
}

/// Its sigma per axis.
inline double placeSigma(const Matrix<3, 3>& information) {
  return std::sqrt(placeCovariance(information).trace() / 3.0);
}

}  // namespace pos::estimation
