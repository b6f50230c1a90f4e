#pragma once
/// A circle of known radius through points of its near side (Zheng et al. 2021, section 3; spec B, B5).

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <span>

namespace pos::lidar {

/// How much a point counts.
/// Even: all alike, as the spec has it. Noise: by what its noise does to its distance from the circle: a beam
/// that grazes the leg is off along itself, hardly across the circle. Huber: the same, and points that stand
/// out count less (Huber 1981, k = 1.345).
enum class ArcWeights { Even, Noise, Huber };

struct CircleFitConfig {
  double radius = 0.15;         ///< m
  double sigma_range = 0.010;   ///< m, of a beam
  double sigma_angle = 3.5e-4;  ///< rad, of a beam (0.02 deg)
  ArcWeights weights = ArcWeights::Huber;
  int iterations_max = 10;      ///< four to seven are needed
  double step_small = 1e-6;     ///< m, where the iteration ends
  double condition_min = 1e-3;  ///< smallest over largest eigenvalue of the information
};

struct CircleFit {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();          ///< m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< m^2
  double rms = 0.0;                                          ///< m, of the distances to the circle
  int iterations = 0;
};

/// e = |p - c| - r and J = d e / d c = -(p - c)' / |p - c|.
struct CircleResidual {
  double e = 0.0;  ///< m
  Eigen::Vector2d J = Eigen::Vector2d::Zero();
};
inline CircleResidual circleResidual(const Eigen::Vector2d& p, const Eigen::Vector2d& centre, double radius) {
  const Eigen::Vector2d away = p - centre;
  const double distance = std::max(away.norm(), 1e-12);
  return {.e = distance - radius, .J = away / -distance};
}

/// Gauss-Newton from the nearest point + r along the mean bearing. Points in the scanner's frame (m), the
/// scanner at the origin. Nothing when it does not converge, or the arc is too short for a direction to be
/// told (condition_min). The covariance is that of the weighted estimate under the beams' noise,
/// (J'WJ)^-1 J'W V W J (J'WJ)^-1; with even weights and noise it is the spec's sigma^2 (J'J)^-1 only if the
/// noise were across the circle. Does not allocate.
std::optional<CircleFit> fittedCircle(std::span<const Eigen::Vector2d> points, const CircleFitConfig& config);

}  // namespace pos::lidar
