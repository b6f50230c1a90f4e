#include "pos/filters/resampling.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"
#include "pos/filters/fast_math.hpp"
#include "pos/filters/lanes.hpp"

namespace pos::filters {
namespace {

void gather(std::vector<float>& to, const std::vector<float>& from, std::span<const std::uint32_t> index) {
  for (std::size_t k = 0; k < index.size(); ++k) to[k] = from[index[k]];
}

}  // namespace

std::span<const std::uint32_t> SystematicResampler::ancestors(std::span<const float> log_weight,
                                                              std::size_t count, double offset) {
  const std::size_t n = log_weight.size();
  ensure(n > 0 && count > 0, "resampling needs particles");
  ancestors_.resize(count);
  weight_.resize(n);
  const float top = laneMax(log_weight);
  double total = 0.0;
  for (std::size_t i = 0; i < n; ++i) weight_[i] = relativeWeight(log_weight[i] - top);
  for (std::size_t i = 0; i < n; ++i) total += static_cast<double>(weight_[i]);
  // Parent i owns the teeth k with cumulative before <= k + offset < cumulative after, in units of a tooth.
  const double teeth = static_cast<double>(count) / total;
  double cumulative = 0.0;
  std::size_t k = 0;
  for (std::size_t i = 0; i < n; ++i) {
    cumulative += static_cast<double>(weight_[i]);
    const double end = cumulative * teeth - offset;
    while (k < count && static_cast<double>(k) < end) ancestors_[k++] = static_cast<std::uint32_t>(i);
  }
  // Rounding may leave the last tooth just beyond the end.
  const std::uint32_t last = k > 0 ? ancestors_[k - 1] : static_cast<std::uint32_t>(n - 1);
  for (; k < count; ++k) ancestors_[k] = last;
  return ancestors_;
}

void SystematicResampler::resample(ParticleSet& set, std::size_t count, RandomStream& stream) {
  const std::span<const std::uint32_t> parents = ancestors(set.log_weight, count, stream.uniform());
  children_.resize(count);
  children_.origin = set.origin;
  gather(children_.x, set.x, parents);
  gather(children_.y, set.y, parents);
  gather(children_.yaw, set.yaw, parents);
  levelWeights(children_);
  std::swap(set, children_);
}

}  // namespace pos::filters
