#include "pos/estimation/range_likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/filters/parallel.hpp"
#include "range_kernels.hpp"

namespace pos::estimation {
namespace kernel {

const RangeKernels& rangeKernels(InstructionSet set) {
  switch (set) {
    case InstructionSet::Avx2:
      return kAvx2;
    case InstructionSet::Avx512:
      return kAvx512;
    case InstructionSet::Portable:
      break;
  }
  return kPortable;
}

}  // namespace kernel

namespace {

constexpr double kSmallMean = 1e-8;  // of the weights: far enough above kLeastWeight for one range more
constexpr double kLog2e = 1.4426950408889634;

/// The numbers of a range that all particles share.
kernel::RangeBlock constants(const RangeTerm& term, double peak, double outlier) {
  const Eigen::Vector3f anchor = term.anchor.cast<float>();
  const Eigen::Vector3f tag = term.tag.cast<float>();
  const float height = anchor.z() - tag.z();
  kernel::RangeBlock block{};
  block.anchor_x = anchor.x();
  block.anchor_y = anchor.y();
  block.height2 = height * height;
  block.tag_x = tag.x();
  block.tag_y = tag.y();
  block.range = static_cast<float>(term.range);
  block.slope = static_cast<float>(-0.5 * kLog2e / (term.sigma * term.sigma));
  block.inlier = static_cast<float>((peak - outlier) / peak);
  block.outlier = static_cast<float>(outlier / peak);
  block.power = static_cast<float>(term.exponent);
  return block;
}

}  // namespace

RangeSums RangeWeights::evaluate(const filters::ParticleSet& set, const filters::HeadingTable& headings,
                                 const RangeTerm& term) {
  const double outlier = term.outlier_probability / term.range_max;
  const double peak = (1.0 - term.outlier_probability) / (std::sqrt(2.0 * kPi) * term.sigma) + outlier;
  posterior_.resize(set.size());
  log_peak_ = term.exponent * std::log(peak);
  kernel::RangeBlock whole = constants(term, peak, outlier);
  whole.centre = std::sqrt((whole.anchor_x - set.x[0]) * (whole.anchor_x - set.x[0]) +
                           (whole.anchor_y - set.y[0]) * (whole.anchor_y - set.y[0]) + whole.height2);
  const kernel::RangeKernels& kernels = kernel::rangeKernels(with_);
  const auto loop = term.exponent == 1.0 ? kernels.whole : kernels.power;
  std::vector<kernel::RangeBlockSums> parts(filters::blockCount(set.size()));
  forBlocks(set.size(), filters::Cost::Low, [&](const filters::Block& b) {
    kernel::RangeBlock block = whole;
    block.x = set.x.data() + b.first;
    block.y = set.y.data() + b.first;
    block.cosine = headings.cosine.data() + b.first;
    block.sine = headings.sine.data() + b.first;
    block.weight = set.weight.data() + b.first;
    block.posterior = posterior_.data() + b.first;
    block.count = b.count;
    parts[b.index] = loop(block);
  });
  kernel::RangeBlockSums sums{};
  for (const kernel::RangeBlockSums& part : parts) {
    sums.weight += part.weight;
    sums.likelihood += part.likelihood;
    sums.distance += part.distance;
    sums.distance2 += part.distance2;
  }
  mean_weight_ = sums.weight / static_cast<double>(set.size());
  const double mean = sums.distance / sums.weight;
  const double evidence = peak * sums.likelihood / sums.weight;
  return {evidence, std::max(0.0, (evidence - outlier) / evidence), static_cast<double>(whole.centre) + mean,
          std::max(0.0, sums.distance2 / sums.weight - mean * mean)};
}

void RangeWeights::apply(filters::ParticleSet& set) {
  std::swap(set.weight, posterior_);
  set.log_scale += log_peak_;
  if (mean_weight_ < kSmallMean) rescale(set, with_);
}

}  // namespace pos::estimation
