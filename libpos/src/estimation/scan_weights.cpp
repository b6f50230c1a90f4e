#include "pos/estimation/scan_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pos/filters/parallel.hpp"

namespace pos::estimation {
namespace {

constexpr std::size_t kSlice = 512;  // particles turned into the grid's frame at a time

lidar::Cells cellsOf(const map::OccupancyGrid& grid) {
  return {.columns = grid.columns,
          .rows = grid.rows,
          .resolution = grid.resolution,
          .x_min = grid.x_min,
          .y_min = grid.y_min,
          .occupancy = grid.occupancy};
}

}  // namespace

ScanWeights::ScanWeights(const map::OccupancyGrid& grid, const ScanLikelihood& config, InstructionSet with)
    : with_(with),
      T_map_grid_(grid.T_map_grid),
      field_(cellsOf(grid), {.sigma = config.sigma,
                             .outlier_probability = config.outlier_probability,
                             .distance_max = config.distance_max}) {}

/// Particles first .. first + count, at most kSlice of them, seen in the grid's frame.
void ScanWeights::addScores(const filters::ParticleSet& set, const filters::HeadingTable& headings,
                            const lidar::BeamPoints& points, std::size_t first, std::size_t count) {
  const auto c = static_cast<float>(std::cos(T_map_grid_.yaw));
  const auto s = static_cast<float>(std::sin(T_map_grid_.yaw));
  const Eigen::Vector2f offset = (set.origin - T_map_grid_.translation()).cast<float>();
  const float ox = offset.x();
  const float oy = offset.y();
  std::array<float, kSlice> x, y, cosine, sine;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = first + k;
    x[k] = c * (set.x[i] + ox) + s * (set.y[i] + oy);
    y[k] = c * (set.y[i] + oy) - s * (set.x[i] + ox);
    cosine[k] = c * headings.cosine[i] + s * headings.sine[i];
    sine[k] = c * headings.sine[i] - s * headings.cosine[i];
  }
  field_.addScores({{x.data(), count}, {y.data(), count}, {cosine.data(), count}, {sine.data(), count}},
                   points, {posterior_.data() + first, count}, with_);
}

double ScanWeights::evaluate(const filters::ParticleSet& set, const filters::HeadingTable& headings,
                             const lidar::BeamPoints& points, double exponent) {
  posterior_.assign(set.size(), 0.0F);
  forBlocks(set.size(), filters::Cost::High, [&](const filters::Block& block) {
    const std::size_t end = block.first + block.count;
    for (std::size_t first = block.first; first < end; first += kSlice) {
      addScores(set, headings, points, first, std::min(kSlice, end - first));
    }
  });
  const filters::Weighed weighed = filters::weigh(set, posterior_, exponent, with_);
  log_scale_ = weighed.log_scale;
  const double beams = exponent * std::accumulate(points.weight.begin(), points.weight.end(), 0.0);
  return std::exp(weighed.log_evidence / beams);
}

void ScanWeights::apply(filters::ParticleSet& set) {
  std::swap(set.weight, posterior_);
  set.log_scale += log_scale_;
  rescale(set, with_);
}

}  // namespace pos::estimation
