#pragma once
/// How well a particle's place explains one beacon range: a Gaussian for good ranges plus a uniform share for
/// those that say nothing, long or short.

#include <Eigen/Core>
#include <vector>

#include "pos/filters/particle_set.hpp"

namespace pos::estimation {

/// One range, made ready for the loop over particles. p(r | x) = (1 - p) N(r; |anchor - tag(x)|, sigma^2) + p
/// / R.
struct RangeTerm {
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< m; x, y from the particle set's origin, z map height
  Eigen::Vector3d tag = Eigen::Vector3d::Zero();     ///< m; x, y on the body, z map height
  double range = 0.0;                                ///< m, known biases taken off
  double sigma = 0.2;                                ///< m
  double outlier_probability = 0.1;                  ///< p
  double range_max = 100.0;                          ///< R, m
  double exponent = 1.0;  ///< share of independent information: the likelihood is raised to this power
};

/// What the cloud as a whole says of the range.
struct RangeSums {
  double evidence = 0.0;            ///< 1/m: weighted mean of the likelihood
  double inlier_share = 0.0;        ///< probability that the range is a good one
  double predicted = 0.0;           ///< m: weighted mean distance
  double predicted_variance = 0.0;  ///< m^2
};

/// Owns the buffer of the loop, 4 bytes a particle. One pass over the particles computes the sums and what
/// the weights would become: look first (`evaluate`), then `apply` or leave it.
class RangeWeights {
 public:
  explicit RangeWeights(InstructionSet with = bestInstructionSet()) : with_(with) {}

  RangeSums evaluate(const filters::ParticleSet& set, const filters::HeadingTable& headings,
                     const RangeTerm& term);
  /// Give the same, unchanged set the weights of the last evaluation. Once only.
  void apply(filters::ParticleSet& set);

 private:
  InstructionSet with_;
  FloatArray posterior_;
  double mean_weight_ = 1.0;  // before the range
  double log_peak_ = 0.0;     // ln of what the weights were divided by, 1/m, times the exponent
};

}  // namespace pos::estimation
