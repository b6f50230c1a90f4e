#include "pos/filters/particle_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pos/core/error.hpp"
#include "pos/core/wide.hpp"
#include "pos/filters/fast_math.hpp"
#include "pos/filters/lanes.hpp"

namespace pos::filters {
namespace {

constexpr std::size_t kBlock = 256;

}  // namespace

namespace kernel {

/// Sums of w and w^2 with w = exp(log weight - top).
struct WeightSums {
  double first = 0.0;
  double second = 0.0;
};

POS_WIDE WeightSums weightSums(std::span<const float> log_weight, float top) {
  WeightSums sums;
  std::array<float, kBlock> w;
  std::array<float, kBlock> w2;
  for (std::size_t first = 0; first < log_weight.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, log_weight.size() - first);
    const float* lw = log_weight.data() + first;
    for (std::size_t i = 0; i < count; ++i) {
      w[i] = relativeWeight(lw[i] - top);
      w2[i] = w[i] * w[i];
    }
    sums.first += laneSum({w.data(), count});
    sums.second += laneSum({w2.data(), count});
  }
  return sums;
}

}  // namespace kernel

void ParticleSet::resize(std::size_t count) {
  x.resize(count);
  y.resize(count);
  yaw.resize(count);
  log_weight.resize(count);
}

Pose2 ParticleSet::pose(std::size_t i) const {
  return {origin.x() + static_cast<double>(x[i]), origin.y() + static_cast<double>(y[i]),
          static_cast<double>(yaw[i])};
}

void ParticleSet::place(std::size_t i, const Pose2& pose_map) {
  x[i] = static_cast<float>(pose_map.x - origin.x());
  y[i] = static_cast<float>(pose_map.y - origin.y());
  yaw[i] = static_cast<float>(wrapAngle(pose_map.yaw));
}

void moveOrigin(ParticleSet& set, const Eigen::Vector2d& origin) {
  const Eigen::Vector2f shift = (set.origin - origin).cast<float>();
  for (float& x : set.x) x += shift.x();
  for (float& y : set.y) y += shift.y();
  set.origin = origin;
}

void levelWeights(ParticleSet& set) {
  std::fill(set.log_weight.begin(), set.log_weight.end(), -std::log(static_cast<float>(set.size())));
}

double logSumExp(std::span<const float> log_weight) {
  const float top = laneMax(log_weight);
  if (!std::isfinite(top)) return static_cast<double>(top);
  return static_cast<double>(top) + std::log(kernel::weightSums(log_weight, top).first);
}

double normalise(std::span<float> log_weight) {
  const double total = logSumExp(log_weight);
  ensure(std::isfinite(total), "particle weights have no finite sum");
  const auto shift = static_cast<float>(total);
  for (float& lw : log_weight) lw -= shift;
  return total;
}

double effectiveSize(std::span<const float> log_weight) {
  const kernel::WeightSums sums = kernel::weightSums(log_weight, laneMax(log_weight));
  return sums.first * sums.first / sums.second;
}

Moments moments(const ParticleSet& set) {
  const std::size_t n = set.size();
  ensure(n > 0, "no particles to average");
  const float top = laneMax(set.log_weight);
  // Raw moments about particle 0, which lies inside the cloud: no digits are lost to a far origin.
  const float x0 = set.x[0];
  const float y0 = set.y[0];
  double total = 0.0;
  double cosine = 0.0;
  double sine = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const double w = relativeWeight(set.log_weight[i] - top);
    const SineCosine direction = fastSineCosine(set.yaw[i]);
    total += w;
    cosine += w * static_cast<double>(direction.cosine);
    sine += w * static_cast<double>(direction.sine);
    mean += w * Eigen::Vector2d(set.x[i] - x0, set.y[i] - y0);
  }
  mean /= total;
  const double yaw = std::atan2(sine, cosine);
  const auto mean_yaw = static_cast<float>(yaw);
  Matrix<3, 3> spread = Matrix<3, 3>::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    const double w = relativeWeight(set.log_weight[i] - top);
    const Vector<3> d(static_cast<double>(set.x[i] - x0) - mean.x(),
                      static_cast<double>(set.y[i] - y0) - mean.y(), fastWrap(set.yaw[i] - mean_yaw));
    spread.noalias() += (w * d) * d.transpose();
  }
  const Pose2 first = set.pose(0);
  return {{first.x + mean.x(), first.y + mean.y(), yaw}, spread / total};
}

}  // namespace pos::filters
