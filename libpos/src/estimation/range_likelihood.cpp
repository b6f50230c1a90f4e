#include "pos/estimation/range_likelihood.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/wide.hpp"
#include "pos/filters/fast_math.hpp"
#include "pos/filters/lanes.hpp"

namespace pos::estimation {
namespace {

constexpr std::size_t kBlock = 256;  // sums of a block fit in the first-level cache

}  // namespace

namespace kernel {

/// One range's constants and up to kBlock particles.
struct Block {
  float ax, ay, dz2;  // anchor from the set's origin; squared height above the tag, m and m^2
  float tx, ty;       // tag on the body, m
  float range, peak, scale;
  float top, centre;
  const float* x;
  const float* y;
  const float* cosine;
  const float* sine;
  const float* log_weight;
  float* inlier;
  std::size_t count;
};

struct Sums {
  double weight, inlier, distance, distance2;
};

POS_WIDE Sums rangeSums(const Block& block) {
  const float* __restrict x = block.x;
  const float* __restrict y = block.y;
  const float* __restrict c = block.cosine;
  const float* __restrict s = block.sine;
  const float* __restrict lw = block.log_weight;
  float* __restrict inlier = block.inlier;
  const auto [ax, ay, dz2, tx, ty, range, peak, scale, top, centre] =
      std::array{block.ax,    block.ay,   block.dz2,   block.tx,  block.ty,
                 block.range, block.peak, block.scale, block.top, block.centre};
  alignas(32) std::array<float, kBlock> w;
  alignas(32) std::array<float, kBlock> w_inlier;
  alignas(32) std::array<float, kBlock> w_d;
  alignas(32) std::array<float, kBlock> w_d2;
  for (std::size_t i = 0; i < block.count; ++i) {
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
  return {filters::laneSum({w.data(), block.count}), filters::laneSum({w_inlier.data(), block.count}),
          filters::laneSum({w_d.data(), block.count}), filters::laneSum({w_d2.data(), block.count})};
}

POS_WIDE void addLogLikelihood(float* __restrict lw, const float* __restrict inlier, std::size_t count,
                               float outlier, float exponent) {
  for (std::size_t i = 0; i < count; ++i) lw[i] += exponent * filters::fastLog(inlier[i] + outlier);
}

}  // namespace kernel

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
  const float ax = anchor.x();
  const float ay = anchor.y();
  const float dz2 = (anchor.z() - tag.z()) * (anchor.z() - tag.z());
  const float top = filters::laneMax(set.log_weight);
  const float centre = std::sqrt((ax - set.x[0]) * (ax - set.x[0]) + (ay - set.y[0]) * (ay - set.y[0]) + dz2);
  double total = 0.0;
  double good = 0.0;
  double first = 0.0;
  double second = 0.0;
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const kernel::Sums sums = kernel::rangeSums({.ax = ax,
                                                 .ay = ay,
                                                 .dz2 = dz2,
                                                 .tx = tag.x(),
                                                 .ty = tag.y(),
                                                 .range = static_cast<float>(term.range),
                                                 .peak = peak,
                                                 .scale = scale,
                                                 .top = top,
                                                 .centre = centre,
                                                 .x = set.x.data() + begin,
                                                 .y = set.y.data() + begin,
                                                 .cosine = headings.cosine.data() + begin,
                                                 .sine = headings.sine.data() + begin,
                                                 .log_weight = set.log_weight.data() + begin,
                                                 .inlier = inlier_.data() + begin,
                                                 .count = std::min(kBlock, n - begin)});
    total += sums.weight;
    good += sums.inlier;
    first += sums.distance;
    second += sums.distance2;
  }
  const double mean = first / total;
  const double evidence = good / total + static_cast<double>(outlier_);
  return {evidence, good / total / evidence, static_cast<double>(centre) + mean,
          std::max(0.0, second / total - mean * mean)};
}

void RangeWeights::apply(filters::ParticleSet& set) const {
  kernel::addLogLikelihood(set.log_weight.data(), inlier_.data(), set.size(), outlier_, exponent_);
}

}  // namespace pos::estimation
