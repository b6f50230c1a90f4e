#include "pos/estimation/range_likelihood.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/filters/fast_math.hpp"
#include "pos/filters/lanes.hpp"

namespace pos::estimation {
namespace {

constexpr std::size_t kBlock = 256;  // sums of a block fit in the first-level cache

}  // namespace

RangeSums RangeWeights::evaluate(const filters::ParticleSet& set, const Headings& headings,
                                 const RangeTerm& term) {
  const std::size_t n = set.size();
  inlier_.resize(n);
  outlier_ = static_cast<float>(term.outlier_probability / term.range_max);
  exponent_ = static_cast<float>(term.exponent);
  const auto peak =
      static_cast<float>((1.0 - term.outlier_probability) / (std::sqrt(2.0 * kPi) * term.sigma));
  const auto scale = static_cast<float>(-0.5 / (term.sigma * term.sigma));
  const Eigen::Vector3f anchor = term.anchor.cast<float>();
  const Eigen::Vector3f tag = term.tag.cast<float>();
  const auto range = static_cast<float>(term.range);
  const float ax = anchor.x();
  const float ay = anchor.y();
  const float dz2 = (anchor.z() - tag.z()) * (anchor.z() - tag.z());
  const float tx = tag.x();
  const float ty = tag.y();
  const float top = filters::laneMax(set.log_weight);
  const float centre = std::sqrt((ax - set.x[0]) * (ax - set.x[0]) + (ay - set.y[0]) * (ay - set.y[0]) + dz2);
  double total = 0.0;
  double good = 0.0;
  double first = 0.0;
  double second = 0.0;
  std::array<float, kBlock> w;
  std::array<float, kBlock> w_inlier;
  std::array<float, kBlock> w_d;
  std::array<float, kBlock> w_d2;
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const std::size_t count = std::min(kBlock, n - begin);
    const float* __restrict x = set.x.data() + begin;
    const float* __restrict y = set.y.data() + begin;
    const float* __restrict lw = set.log_weight.data() + begin;
    const float* __restrict c = headings.cosine.data() + begin;
    const float* __restrict s = headings.sine.data() + begin;
    float* __restrict inlier = inlier_.data() + begin;
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = ax - x[i] - (c[i] * tx - s[i] * ty);
      const float dy = ay - y[i] - (s[i] * tx + c[i] * ty);
      const float d = std::sqrt(dx * dx + dy * dy + dz2);
      const float nu = range - d;
      inlier[i] = peak * filters::relativeWeight(scale * nu * nu);
      w[i] = filters::relativeWeight(lw[i] - top);
      w_inlier[i] = w[i] * inlier[i];
      w_d[i] = w[i] * (d - centre);
      w_d2[i] = w_d[i] * (d - centre);
    }
    total += filters::laneSum({w.data(), count});
    good += filters::laneSum({w_inlier.data(), count});
    first += filters::laneSum({w_d.data(), count});
    second += filters::laneSum({w_d2.data(), count});
  }
  const double mean = first / total;
  const double evidence = good / total + static_cast<double>(outlier_);
  return {evidence, good / total / evidence, static_cast<double>(centre) + mean,
          std::max(0.0, second / total - mean * mean)};
}

void RangeWeights::apply(filters::ParticleSet& set) const {
  float* lw = set.log_weight.data();
  const float* inlier = inlier_.data();
  const float exponent = exponent_;
  const float outlier = outlier_;
  const std::size_t n = set.size();
  for (std::size_t i = 0; i < n; ++i) lw[i] += exponent * filters::fastLog(inlier[i] + outlier);
}

}  // namespace pos::estimation
