#include "pos/estimation/scan_weights.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pos::estimation {
namespace {

lidar::Cells cellsOf(const map::OccupancyGrid& grid) {
  return {.columns = grid.columns,
          .rows = grid.rows,
          .resolution = grid.resolution,
          .x_min = grid.x_min,
          .y_min = grid.y_min,
          .occupancy = grid.occupancy};
}

}  // namespace

ScanWeights::ScanWeights(const map::OccupancyGrid& grid, const ScanLikelihood& config)
    : T_map_grid_(grid.T_map_grid),
      field_(cellsOf(grid), {.sigma = config.sigma,
                             .outlier_probability = config.outlier_probability,
                             .distance_max = config.distance_max}) {}

double ScanWeights::evaluate(const filters::ParticleSet& set, const Headings& headings,
                             const lidar::BeamPoints& points, double exponent) {
  const std::size_t n = set.size();
  for (auto* buffer : {&x_, &y_, &cosine_, &sine_, &posterior_}) buffer->resize(n);
  score_.assign(n, 0.0F);
  const auto c = static_cast<float>(std::cos(T_map_grid_.yaw));
  const auto s = static_cast<float>(std::sin(T_map_grid_.yaw));
  const Eigen::Vector2f offset = (set.origin - T_map_grid_.translation()).cast<float>();
  const float ox = offset.x();
  const float oy = offset.y();
  for (std::size_t i = 0; i < n; ++i) {
    x_[i] = c * (set.x[i] + ox) + s * (set.y[i] + oy);
    y_[i] = c * (set.y[i] + oy) - s * (set.x[i] + ox);
    cosine_[i] = c * headings.cosine[i] + s * headings.sine[i];
    sine_[i] = c * headings.sine[i] - s * headings.cosine[i];
  }
  field_.addScores({x_, y_, cosine_, sine_}, points, score_);
  const auto power = static_cast<float>(exponent);
  for (std::size_t i = 0; i < n; ++i) {
    score_[i] *= power;
    posterior_[i] = set.log_weight[i] + score_[i];
  }
  const double log_evidence = filters::logSumExp(posterior_) - filters::logSumExp(set.log_weight);
  const double beams = exponent * std::accumulate(points.weight.begin(), points.weight.end(), 0.0);
  return std::exp(log_evidence / beams);
}

void ScanWeights::apply(filters::ParticleSet& set) const {
  for (std::size_t i = 0; i < set.size(); ++i) set.log_weight[i] += score_[i];
}

}  // namespace pos::estimation
