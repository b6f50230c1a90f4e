#pragma once
/// Planar particles as a structure of arrays: each quantity lies alone in memory, in float, so that the loops
/// over particles run as vector code.

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "pos/core/pose2.hpp"

namespace pos::filters {

struct ParticleSet {
  /// Map coordinates (m) of the particles' x = y = 0. Keep the particles within a few hundred metres of it:
  /// float then resolves better than 0.05 mm.
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  std::vector<float> x;           ///< m, east of the origin
  std::vector<float> y;           ///< m, north of the origin
  std::vector<float> yaw;         ///< rad, in [-pi, pi]
  std::vector<float> log_weight;  ///< natural logarithm; normalised only where a function says so

  std::size_t size() const { return x.size(); }
  void resize(std::size_t count);
  Pose2 pose(std::size_t i) const;
  /// Place particle i at a map pose; its weight stays.
  void place(std::size_t i, const Pose2& pose_map);
};

/// Move the set's origin to `origin`, the particles staying where they are in the map (to float's precision).
void moveOrigin(ParticleSet& set, const Eigen::Vector2d& origin);

/// All particles equally likely: log weight -log(n).
void levelWeights(ParticleSet& set);

/// ln sum_i exp(log_weight_i), safe from overflow. -infinity when there is no particle.
double logSumExp(std::span<const float> log_weight);

/// Subtract logSumExp from every log weight, so that the weights sum to one. Returns what was subtracted:
/// with weights that summed to one before, the log of the mean likelihood (the evidence) of what was added
/// since.
double normalise(std::span<float> log_weight);

/// Effective sample size (sum w)^2 / sum w^2, between 1 and n; the weights need not be normalised (Kong, Liu,
/// Wong 1994).
double effectiveSize(std::span<const float> log_weight);

/// Mean and spread of the set in the map frame.
struct Moments {
  Pose2 mean;  ///< yaw is the direction of the weighted mean unit vector
  /// Weighted covariance about the mean [x, y, yaw]; yaw differences are wrapped.
  Matrix<3, 3> covariance = Matrix<3, 3>::Zero();
};

/// The weights need not be normalised. At least one particle. O(n), sums in double.
Moments moments(const ParticleSet& set);

}  // namespace pos::filters
