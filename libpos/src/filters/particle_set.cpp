#include "pos/filters/particle_set.hpp"

#include <algorithm>
#include <cmath>

#include "particle_kernels.hpp"
#include "pos/core/error.hpp"
#include "pos/filters/parallel.hpp"

namespace pos::filters {
namespace {

/// What `partial` gives for every block, for the caller to add up in order.
template <class Partial>
auto perBlock(std::size_t particles, const Partial& partial) {
  std::vector<decltype(partial(Block{}))> sums(blockCount(particles));
  forBlocks(particles, Cost::Low, [&](const Block& block) { sums[block.index] = partial(block); });
  return sums;
}

kernel::CloudView view(const ParticleSet& set, const Block& block, const Eigen::Vector2f& centre, float yaw) {
  return {.x = set.x.data() + block.first,
          .y = set.y.data() + block.first,
          .yaw = set.yaw.data() + block.first,
          .weight = set.weight.data() + block.first,
          .count = block.count,
          .x0 = centre.x(),
          .y0 = centre.y(),
          .yaw0 = yaw};
}

}  // namespace

void ParticleSet::resize(std::size_t count) {
  for (FloatArray* array : {&x, &y, &yaw, &weight}) array->resize(count);
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

void fillHeadings(HeadingTable& table, const ParticleSet& set, InstructionSet with) {
  table.cosine.resize(set.size());
  table.sine.resize(set.size());
  const auto headings = kernel::particleKernels(with).headings;
  forBlocks(set.size(), Cost::Low, [&](const Block& b) {
    headings(set.yaw.data() + b.first, table.cosine.data() + b.first, table.sine.data() + b.first, b.count);
  });
}

void moveOrigin(ParticleSet& set, const Eigen::Vector2d& origin) {
  const Eigen::Vector2f shift = (set.origin - origin).cast<float>();
  for (float& x : set.x) x += shift.x();
  for (float& y : set.y) y += shift.y();
  set.origin = origin;
}

void levelWeights(ParticleSet& set) {
  std::fill(set.weight.begin(), set.weight.end(), 1.0F);
  set.log_scale = 0.0;
}

WeightSums weightSums(const ParticleSet& set, InstructionSet with) {
  const auto partial = kernel::particleKernels(with).weightSums;
  WeightSums sums;
  for (const kernel::WeightSums& part :
       perBlock(set.size(), [&](const Block& b) { return partial(set.weight.data() + b.first, b.count); })) {
    sums.first += part.first;
    sums.second += part.second;
  }
  return sums;
}

double logEvidence(const ParticleSet& set) {
  return std::log(weightSums(set).first / static_cast<double>(set.size())) + set.log_scale;
}

double normalise(ParticleSet& set, InstructionSet with) {
  const double mean = weightSums(set, with).first / static_cast<double>(set.size());
  ensure(std::isfinite(mean) && mean > 0.0, "particle weights have no finite sum");
  const auto scale = kernel::particleKernels(with).scale;
  const auto factor = static_cast<float>(1.0 / mean);
  forBlocks(set.size(), Cost::Low,
            [&](const Block& b) { scale(set.weight.data() + b.first, b.count, factor); });
  const double evidence = std::log(mean) + set.log_scale;
  set.log_scale = 0.0;
  return evidence;
}

Weighed weigh(const ParticleSet& set, FloatArray& log_likelihood, double exponent, InstructionSet with) {
  const kernel::ParticleKernels& kernels = kernel::particleKernels(with);
  const auto tops = perBlock(
      set.size(), [&](const Block& b) { return kernels.largest(log_likelihood.data() + b.first, b.count); });
  const float top = *std::max_element(tops.begin(), tops.end());
  const auto slope = static_cast<float>(exponent / std::log(2.0));
  kernel::WeightSums sums{};
  for (const kernel::WeightSums& part : perBlock(set.size(), [&](const Block& b) {
         return kernels.weigh({.weight = set.weight.data() + b.first,
                               .value = log_likelihood.data() + b.first,
                               .count = b.count,
                               .top = top,
                               .slope = slope});
       })) {
    sums.first += part.first;
    sums.second += part.second;
  }
  const double log_scale = exponent * static_cast<double>(top);
  return {std::log(sums.second / sums.first) + log_scale, log_scale};
}

Moments moments(const ParticleSet& set, InstructionSet with) {
  ensure(set.size() > 0, "no particles to average");
  const kernel::ParticleKernels& kernels = kernel::particleKernels(with);
  // Sums count from particle 0, which lies inside the cloud: no digits are lost to a far origin.
  const Eigen::Vector2f start(set.x[0], set.y[0]);
  kernel::DirectionSums sums{};
  for (const kernel::DirectionSums& part :
       perBlock(set.size(), [&](const Block& b) { return kernels.directions(view(set, b, start, 0.0F)); })) {
    sums.weight += part.weight;
    sums.x += part.x;
    sums.y += part.y;
    sums.cosine += part.cosine;
    sums.sine += part.sine;
  }
  const Eigen::Vector2d offset = Eigen::Vector2d(sums.x, sums.y) / sums.weight;
  const double yaw = std::atan2(sums.sine, sums.cosine);
  const Eigen::Vector2f centre = (start.cast<double>() + offset).cast<float>();
  kernel::SpreadSums spread{};
  for (const kernel::SpreadSums& part : perBlock(set.size(), [&](const Block& b) {
         return kernels.spread(view(set, b, centre, static_cast<float>(yaw)));
       })) {
    spread.xx += part.xx;
    spread.xy += part.xy;
    spread.yy += part.yy;
    spread.xa += part.xa;
    spread.ya += part.ya;
    spread.aa += part.aa;
  }
  Matrix<3, 3> covariance;
  covariance << spread.xx, spread.xy, spread.xa,  //
      spread.xy, spread.yy, spread.ya,            //
      spread.xa, spread.ya, spread.aa;
  const Pose2 first = set.pose(0);
  return {{first.x + offset.x(), first.y + offset.y(), yaw}, covariance / sums.weight};
}

}  // namespace pos::filters
