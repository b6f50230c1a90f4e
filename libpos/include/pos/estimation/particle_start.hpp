#pragma once
/// Where particles come from: a Gaussian, the free cells of a grid, the ring of a first range.

#include <cstdint>
#include <optional>
#include <vector>

#include "pos/core/belief.hpp"
#include "pos/core/pose2.hpp"
#include "pos/core/random.hpp"
#include "pos/filters/particle_set.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation {

/// `count` equally weighted samples of a Gaussian; the set's origin is its mean. The covariance may be
/// singular.
filters::ParticleSet gaussianParticles(const Belief<Pose2>& prior, std::size_t count, RandomStream& stream);

/// Every heading drawn anew, uniformly.
void scatterHeadings(filters::ParticleSet& set, RandomStream& stream);

/// Uniform over all places a vehicle can be: the grid's free cells where the map has a grid, else the
/// anchors' box widened by `reach` (m).
class FreeSpace {
 public:
  /// Throws ConfigError when the grid has no free cell, or there is neither a grid nor an anchor.
  FreeSpace(const map::TunnelMap& map, double reach);

  Pose2 sample(RandomStream& stream) const;  ///< map frame, any heading
  Eigen::Vector2d centre() const { return centre_; }
  filters::ParticleSet particles(std::size_t count, RandomStream& stream) const;

 private:
  Pose2 T_map_grid_;
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();  // of the grid or box, its own frame
  Eigen::Vector2d size_ = Eigen::Vector2d::Zero();    // of one cell or of the box
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  int columns_ = 1;
  std::vector<std::uint32_t> free_cells_;
};

/// A ring of particles around an anchor.
struct Ring {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m, map
  double radius = 0.0;                               ///< m, in the plane
  double sigma = 0.0;                                ///< m
  double scattered = 0.0;                            ///< share placed anywhere in the free space instead
};
filters::ParticleSet ringParticles(const Ring& ring, const FreeSpace& anywhere, std::size_t count,
                                   RandomStream& stream);

}  // namespace pos::estimation
