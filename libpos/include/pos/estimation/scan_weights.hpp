#pragma once
/// How well each particle's pose explains a scan, read from the likelihood field of the map's grid.

#include <span>
#include <vector>

#include "pos/estimation/configs.hpp"
#include "pos/estimation/range_likelihood.hpp"
#include "pos/filters/particle_set.hpp"
#include "pos/lidar/likelihood_field.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation {

/// Owns the field and the buffers of the loop. Look first (`evaluate`), then `apply` or leave it.
class ScanWeights {
 public:
  ScanWeights(const map::OccupancyGrid& grid, const ScanLikelihood& config);

  /// Weighs the scan's likelihood to the power `exponent`. Returns its mean over the cloud per independent
  /// beam, between p (every beam an outlier) and 1 (every beam on an obstacle).
  double evaluate(const filters::ParticleSet& set, const Headings& headings, const lidar::BeamPoints& points,
                  double exponent);
  /// Add the last evaluated log likelihood to the log weights of the same, unchanged set.
  void apply(filters::ParticleSet& set) const;

 private:
  Pose2 T_map_grid_;
  lidar::LikelihoodField field_;
  std::vector<float> x_;  // particles in the grid's frame
  std::vector<float> y_;
  std::vector<float> cosine_;
  std::vector<float> sine_;
  std::vector<float> score_;
  std::vector<float> posterior_;
};

}  // namespace pos::estimation
