/// The particle filter's way back when it is lost: new particles from the readings ("sensor resetting",
/// Lenser and Veloso 2000) or from anywhere in the free space.

#include <algorithm>
#include <cmath>

#include "pos/estimation/mcl.hpp"

namespace pos::estimation {
namespace {

void append(filters::ParticleSet& set, const filters::ParticleSet& more) {
  const auto extend = [](FloatArray& to, const FloatArray& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  extend(set.x, more.x);
  extend(set.y, more.y);
  extend(set.yaw, more.yaw);
  extend(set.weight, more.weight);
}

}  // namespace

filters::ParticleSet Mcl::newcomers(std::size_t count) {
  std::vector<RangeTerm>& ranges = group_->ranges;
  if (ranges.empty()) return free_space_.particles(count, stream_);
  const auto pick = static_cast<std::size_t>(stream_.uniform() * static_cast<double>(ranges.size()));
  filters::ParticleSet drawn = particlesOnRing(ranges[pick], count);
  ranges.erase(ranges.begin() + static_cast<std::ptrdiff_t>(pick));  // it has had its say
  return drawn;
}

void Mcl::weighByGroup(filters::ParticleSet& set) {
  filters::HeadingTable headings;
  fillHeadings(headings, set);
  for (const RangeTerm& term : group_->ranges) {
    range_weights_.evaluate(set, headings, term);
    range_weights_.apply(set);
  }
  for (std::size_t k = 0; k < group_->scans.size(); ++k) {
    scan_weights_->evaluate(set, headings, group_->scans[k], group_->exponents[k]);
    scan_weights_->apply(set);
  }
}

void Mcl::inject(double share, double log_evidence) {
  const auto count = static_cast<std::size_t>(config_.particles.max);
  const auto drawn = static_cast<std::size_t>(std::ceil(share * static_cast<double>(count)));
  filters::ParticleSet added = newcomers(drawn);
  moveOrigin(added, set_.origin);
  weighByGroup(added);  // the readings that called for them weigh the newcomers too
  resampler_.resample(set_, count - drawn, stream_);
  // Prior (1 - share) old + share new; the old ones' mean likelihood is the evidence. Whichever of the two is
  // less likely is scaled down.
  const double gain = added.log_scale - log_evidence;
  const auto old_weight = (1.0 - share) / static_cast<double>(set_.size()) * std::exp(-std::max(0.0, gain));
  const auto new_weight = share / static_cast<double>(drawn) * std::exp(std::min(0.0, gain));
  const auto weighted = [&](filters::ParticleSet& set, double factor) {
    for (float& w : set.weight) {
      w = std::max(filters::kLeastWeight, static_cast<float>(static_cast<double>(count) * factor * w));
    }
  };
  weighted(set_, old_weight);
  weighted(added, new_weight);
  append(set_, added);
  filters::normalise(set_);
  headings_fresh_ = false;
}

}  // namespace pos::estimation
