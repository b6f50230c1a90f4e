#pragma once
/// How well each particle's pose explains a scan, read from the likelihood field of the map's grid.

#include <vector>

#include "pos/estimation/configs.hpp"
#include "pos/filters/particle_set.hpp"
#include "pos/lidar/likelihood_field.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation {

/// Owns the field and the buffer of the loop, 4 bytes a particle. Look first (`evaluate`), then `apply` or
/// leave it.
class ScanWeights {
 public:
  ScanWeights(const map::OccupancyGrid& grid, const ScanLikelihood& config,
              InstructionSet with = bestInstructionSet());

  /// Weighs the scan's likelihood to the power `exponent`. Returns its mean over the cloud per independent
  /// beam, between p (every beam an outlier) and 1 (every beam on an obstacle).
  double evaluate(const filters::ParticleSet& set, const filters::HeadingTable& headings,
                  const lidar::BeamPoints& points, double exponent);
  /// Give the same, unchanged set the weights of the last evaluation. Once only.
  void apply(filters::ParticleSet& set);

 private:
  void addScores(const filters::ParticleSet& set, const filters::HeadingTable& headings,
                 const lidar::BeamPoints& points, std::size_t first, std::size_t count);

  InstructionSet with_;
  Pose2 T_map_grid_;
  lidar::LikelihoodField field_;
  FloatArray posterior_;
  double log_scale_ = 0.0;
};

}  // namespace pos::estimation
