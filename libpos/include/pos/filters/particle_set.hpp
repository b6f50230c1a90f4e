#pragma once
/// Planar particles as a structure of arrays: each quantity lies alone in memory, in float, so that the loops
/// over particles run as vector code. 16 bytes a particle.

#include <Eigen/Core>
#include <cstddef>

#include "pos/core/aligned.hpp"
#include "pos/core/instruction_set.hpp"
#include "pos/core/pose2.hpp"

namespace pos::filters {

/// No weight falls below this. Beside a mean near 1 it is nothing even for a million particles, and the
/// numbers below 1e-38 that cost ten times as much never come up.
inline constexpr float kLeastWeight = 1e-30F;

struct ParticleSet {
  /// Map coordinates (m) of the particles' x = y = 0. Keep the particles within a few hundred metres of it:
  /// float then resolves better than 0.05 mm.
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  FloatArray x;       ///< m, east of the origin
  FloatArray y;       ///< m, north of the origin
  FloatArray yaw;     ///< rad, in [-pi, pi]
  FloatArray weight;  ///< relative; where a function says "normalised" their mean is 1
  /// ln of a factor common to all weights: the particles' likelihoods are weight * e^log_scale. Keeps float
  /// weights in range however unlikely the readings are.
  double log_scale = 0.0;

  std::size_t size() const { return x.size(); }
  void resize(std::size_t count);
  Pose2 pose(std::size_t i) const;
  /// Place particle i at a map pose; its weight stays.
  void place(std::size_t i, const Pose2& pose_map);
};

/// Cosine and sine of every particle's heading, 8 bytes a particle.
struct HeadingTable {
  FloatArray cosine;
  FloatArray sine;
};
void fillHeadings(HeadingTable& table, const ParticleSet& set, InstructionSet with = bestInstructionSet());

/// Move the set's origin to `origin`, the particles staying where they are in the map (to float's precision).
void moveOrigin(ParticleSet& set, const Eigen::Vector2d& origin);

/// All particles equally likely: weights 1, scale 0.
void levelWeights(ParticleSet& set);

/// Sums of the weights and of their squares, without the scale.
struct WeightSums {
  double first = 0.0;
  double second = 0.0;

  /// Effective sample size (sum w)^2 / sum w^2, between 1 and n (Kong, Liu, Wong 1994).
  double effectiveSize() const { return first * first / second; }
};
WeightSums weightSums(const ParticleSet& set, InstructionSet with = bestInstructionSet());

inline double effectiveSize(const ParticleSet& set) {
  return weightSums(set).effectiveSize();
}

/// ln of the mean weight with its scale: with weights that were normalised before, the log of the mean
/// likelihood (the evidence) of what they were multiplied with since.
double logEvidence(const ParticleSet& set);

/// Bring the mean weight to 1 and the scale to 0. Returns logEvidence.
double normalise(ParticleSet& set, InstructionSet with = bestInstructionSet());

/// Bring the mean weight to 1 and leave the products weight * e^log_scale as they are.
inline void rescale(ParticleSet& set, InstructionSet with = bestInstructionSet()) {
  set.log_scale = normalise(set, with);
}

/// What weighing by log likelihoods gives.
struct Weighed {
  double log_evidence = 0.0;  ///< ln of the weighted mean of the likelihoods to the power `exponent`
  double log_scale = 0.0;     ///< to be added to the set's, together with the new weights
};

/// Turn each log likelihood l_i into the weight that particle i gets from it, w_i e^(exponent (l_i - max l)).
Weighed weigh(const ParticleSet& set, FloatArray& log_likelihood, double exponent,
              InstructionSet with = bestInstructionSet());

/// Mean and spread of the set in the map frame.
struct Moments {
  Pose2 mean;  ///< yaw is the direction of the weighted mean unit vector
  /// Weighted covariance about the mean [x, y, yaw]; yaw differences are wrapped.
  Matrix<3, 3> covariance = Matrix<3, 3>::Zero();
};

/// The weights need not be normalised. At least one particle. O(n); sums in float within a block, in double
/// beyond.
Moments moments(const ParticleSet& set, InstructionSet with = bestInstructionSet());

}  // namespace pos::filters
