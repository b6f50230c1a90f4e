#pragma once
/// How the error grows between two fixes, and how long intervals may be for it (spec A section 6.5).

#include <optional>
#include <vector>

namespace pos::interval {

/// What dead reckoning does after a reset.
struct DriftModel {
  double reset_along = 0.3;   ///< m, sigma_c: how well a passage fixes the chainage
  double reset_across = 0.3;  ///< m, sigma_n0: how well the offset is known there
  double scale = 0.005;       ///< sigma_k: share of the distance
  double random_along = 0.0;  ///< k_d, m^2 per m
  double heading = 0.0087;    ///< rad, sigma_psi at the reset
  double gyro_bias = 0.0;     ///< rad/s, sigma_bg
  double gyro_noise = 0.0;    ///< rad/sqrt(s), N_g
};
DriftModel validated(DriftModel drift);

/// sigma_s after `length` m: sqrt(sigma_c^2 + (sigma_k l)^2 + k_d l).
double alongBound(const DriftModel& drift, double length);
/// sigma_n after `length` m at `speed` m/s:
/// sqrt(sigma_n0^2 + (sigma_psi l)^2 + (sigma_bg l^2 / (2 v))^2 + N_g^2 l^3 / (3 v)).
double acrossBound(const DriftModel& drift, double length, double speed);

/// The design rule: the largest merge factor g for which, at the end of every interval of g chamber spacings,
/// 3 sigma_s <= half of the smallest spacing and 3 sigma_n <= half of the roadway's width; nothing where even
/// g = 1 breaks it. `spacings` are the distances between consecutive chambers, m.
struct LegDesign {
  std::vector<double> spacings = {};
  double width = 5.0;  ///< m
  double speed = 3.0;  ///< m/s
};
std::optional<int> largestMerge(const DriftModel& drift, const LegDesign& leg);

}  // namespace pos::interval
