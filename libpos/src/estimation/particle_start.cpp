#include "pos/estimation/particle_start.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"

namespace pos::estimation {
namespace {

constexpr std::uint8_t kFreeBelow = 35;  // percent

filters::ParticleSet emptySet(const Eigen::Vector2d& origin, std::size_t count) {
  filters::ParticleSet set;
  set.origin = origin;
  set.resize(count);
  levelWeights(set);
  return set;
}

std::vector<std::uint32_t> freeCells(const map::OccupancyGrid& grid) {
  std::vector<std::uint32_t> cells;
  for (std::size_t i = 0; i < grid.occupancy.size(); ++i) {
    if (grid.occupancy[i] < kFreeBelow) cells.push_back(static_cast<std::uint32_t>(i));
  }
  return cells;
}

}  // namespace

filters::ParticleSet gaussianParticles(const Belief<Pose2>& prior, std::size_t count, RandomStream& stream) {
  const Eigen::SelfAdjointEigenSolver<Matrix<3, 3>> eigen(prior.covariance);
  const Matrix<3, 3> root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  filters::ParticleSet set = emptySet(prior.mean.translation(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const double a = stream.normal();
    const double b = stream.normal();
    const double c = stream.normal();
    set.place(i, plus(prior.mean, root * Vector<3>(a, b, c)));
  }
  return set;
}

void scatterHeadings(filters::ParticleSet& set, RandomStream& stream) {
  for (float& yaw : set.yaw) yaw = static_cast<float>(stream.uniform(-kPi, kPi));
}

FreeSpace::FreeSpace(const map::TunnelMap& map, double reach) {
  if (map.grid) {
    const map::OccupancyGrid& grid = *map.grid;
    T_map_grid_ = grid.T_map_grid;
    corner_ = {grid.x_min, grid.y_min};
    size_ = {grid.resolution, grid.resolution};
    columns_ = grid.columns;
    free_cells_ = freeCells(grid);
    const Eigen::Vector2d middle = corner_ + 0.5 * grid.resolution * Eigen::Vector2d(grid.columns, grid.rows);
    centre_ = T_map_grid_ * middle;
  } else if (!map.anchors.empty()) {
    Eigen::Vector2d low = map.anchors.front().p_map.head<2>();
    Eigen::Vector2d high = low;
    for (const map::Anchor& anchor : map.anchors) {
      low = low.cwiseMin(anchor.p_map.head<2>());
      high = high.cwiseMax(anchor.p_map.head<2>());
    }
    corner_ = low.array() - reach;
    size_ = (high - low).array() + 2.0 * reach;
    centre_ = 0.5 * (low + high);
    free_cells_ = {0};  // the box is one cell
  }
  if (free_cells_.empty()) {
    throw ConfigError(Complaint{.what = "the map has no place to start from",
                                .key = "map",
                                .expected = "a grid with free cells, or anchors",
                                .suggestion = "check the grid's occupancy, or give the start pose"});
  }
}

Pose2 FreeSpace::sample(RandomStream& stream) const {
  const auto draw = static_cast<std::size_t>(stream.uniform() * static_cast<double>(free_cells_.size()));
  const std::uint32_t cell = free_cells_[std::min(draw, free_cells_.size() - 1)];
  const auto columns = static_cast<std::uint32_t>(columns_);
  const double column = static_cast<double>(cell % columns) + stream.uniform();
  const double row = static_cast<double>(cell / columns) + stream.uniform();
  const Eigen::Vector2d p_map =
      T_map_grid_ * Eigen::Vector2d(corner_ + Eigen::Vector2d(column, row).cwiseProduct(size_));
  return {p_map.x(), p_map.y(), stream.uniform(-kPi, kPi)};
}

filters::ParticleSet FreeSpace::particles(std::size_t count, RandomStream& stream) const {
  filters::ParticleSet set = emptySet(centre_, count);
  for (std::size_t i = 0; i < count; ++i) set.place(i, sample(stream));
  return set;
}

filters::ParticleSet ringParticles(const Ring& ring, const FreeSpace& anywhere, std::size_t count,
                                   RandomStream& stream) {
  filters::ParticleSet set = emptySet(ring.centre, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (stream.bernoulli(ring.scattered)) {
      set.place(i, anywhere.sample(stream));
      continue;
    }
    const double bearing = stream.uniform(-kPi, kPi);
    const double radius = stream.normal(ring.radius, ring.sigma);
    const Eigen::Vector2d p = ring.centre + radius * Eigen::Vector2d(std::cos(bearing), std::sin(bearing));
    set.place(i, {p.x(), p.y(), stream.uniform(-kPi, kPi)});
  }
  return set;
}

}  // namespace pos::estimation
