#pragma once
/// How well a particle's place explains one beacon range: a Gaussian for good ranges plus a uniform share for
/// those that say nothing, long or short.

#include <Eigen/Core>
#include <span>
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

/// Cosine and sine of every particle's heading.
struct Headings {
  std::span<const float> cosine;
  std::span<const float> sine;
};

/// What the cloud as a whole says of the range.
struct RangeSums {
  double evidence = 0.0;            ///< 1/m: weighted mean of the likelihood
  double inlier_share = 0.0;        ///< probability that the range is a good one
  double predicted = 0.0;           ///< m: weighted mean distance
  double predicted_variance = 0.0;  ///< m^2
};

/// Owns the buffers of the loop. Look first (`evaluate`), then `apply` or leave it.
class RangeWeights {
 public:
  RangeSums evaluate(const filters::ParticleSet& set, const Headings& headings, const RangeTerm& term);
  /// Add the last evaluated log likelihood to the log weights of the same, unchanged set.
  void apply(filters::ParticleSet& set) const;

 private:
  std::vector<float> inlier_;  // (1 - p) N(...), 1/m
  float outlier_ = 0.0F;       // p / R, 1/m
  float exponent_ = 1.0F;
};

}  // namespace pos::estimation
