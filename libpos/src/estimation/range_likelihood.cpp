#include "pos/estimation/range_likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/filters/fast_math.hpp"

namespace pos::estimation {

RangeSums RangeWeights::evaluate(const filters::ParticleSet& set, const Headings& headings,
                                 const RangeTerm& term) {
  const std::size_t n = set.size();
  distance_.resize(n);
  inlier_.resize(n);
  weight_.resize(n);
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
  const float top = *std::max_element(set.log_weight.begin(), set.log_weight.end());
  const float* x = set.x.data();
  const float* y = set.y.data();
  const float* lw = set.log_weight.data();
  const float* c = headings.cosine.data();
  const float* s = headings.sine.data();
  float* distance = distance_.data();
  float* inlier = inlier_.data();
  float* weight = weight_.data();
  for (std::size_t i = 0; i < n; ++i) {
    const float dx = ax - x[i] - (c[i] * tx - s[i] * ty);
    const float dy = ay - y[i] - (s[i] * tx + c[i] * ty);
    const float d = std::sqrt(dx * dx + dy * dy + dz2);
    const float nu = range - d;
    distance[i] = d;
    inlier[i] = peak * filters::fastExp(scale * nu * nu);
    weight[i] = filters::fastExp(lw[i] - top);
  }
  double total = 0.0;
  double good = 0.0;
  double first = 0.0;
  double second = 0.0;
  const float centre = distance[0];
  for (std::size_t i = 0; i < n; ++i) {
    const double w = weight[i];
    const double d = distance[i] - centre;
    total += w;
    good += w * static_cast<double>(inlier[i]);
    first += w * d;
    second += w * d * d;
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
