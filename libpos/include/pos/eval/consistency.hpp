#pragma once
/// Does the estimator know how wrong it is? NEES against chi-square bounds, and the share inside 3 sigma.

#include <cstddef>
#include <optional>
#include <vector>

#include "pos/core/chi_square.hpp"
#include "pos/eval/errors.hpp"

namespace pos::eval {

enum class Honesty {
  Unknown,      ///< no covariance to judge
  TooSure,      ///< mean NEES above the bounds: the claimed sigmas are too small
  Consistent,   ///< inside
  TooCautious,  ///< below: the claimed sigmas are too large
};

/// Mean NEES with two-sided 95 % bounds (Bar-Shalom, Li, Kirubarajan 2001, section 5.4.2).
///
/// Successive errors of one run are correlated: 10 000 estimates of a slowly wandering error carry the
/// information of perhaps fifty independent ones. `naive_bounds` pretend that all samples are independent
/// (far too tight for one run); `bounds` use the effective number of samples from the autocorrelation of the
/// NEES series itself (see effectiveSampleSize).
struct NeesSummary {
  int dof = 0;
  std::size_t count = 0;
  double mean = 0.0;
  double effective_count = 0.0;
  Interval bounds;
  Interval naive_bounds;

  Honesty honesty() const;
  /// sqrt(mean / dof): the claimed sigmas would have to be multiplied by this.
  double sigmaFactor() const;
  /// How wrong (m per axis) a truth would be that alone explains a mean NEES above its expected value, given
  /// the xy rmse; 0 where there is nothing to explain. Good for errors and claims that vary little.
  double explainingTruthSigma(double rmse_xy) const;
};

/// Summary of a NEES series with `dof` degrees of freedom each.
NeesSummary neesSummary(const std::vector<double>& nees, int dof);

/// n / (1 + 2 sum of autocorrelations), the sum cut by Geyer's initial positive sequence (Geyer 1992, section
/// 3.3), in [1, n]. Long series are averaged over blocks first, which leaves the variance of the mean as it
/// is. A constant series counts as one sample. O(n + blocks * lags).
double effectiveSampleSize(const std::vector<double>& series);

/// Share of the samples whose error lies inside 3 claimed sigmas (99.7 % when honest and Gaussian); nothing
/// where no sample has a sigma.
std::optional<double> fractionInside3Sigma(const ErrorSeries& series, Component which);

struct Consistency {
  NeesSummary nees_xy;
  NeesSummary nees_pose;
  double truth_sigma = 0.0;  ///< m per axis, counted into the NEES for the truth; 0: a perfect truth
  std::size_t without_covariance = 0;  ///< samples whose xy covariance cannot be inverted
  std::optional<double> inside_x;      ///< shares inside 3 sigma
  std::optional<double> inside_y;
  std::optional<double> inside_along;
  std::optional<double> inside_cross;
  std::optional<double> inside_yaw;
};

Consistency consistency(const ErrorSeries& series);

}  // namespace pos::eval
