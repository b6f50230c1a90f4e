#include "pos/estimation/anchor_table.hpp"

#include <cmath>

namespace pos::estimation {

RangeBias predicted(const RangeBias& bias, const RangeLikelihood& model, double dt) {
  const double keep = std::exp(-dt / model.bias_time);
  const double steady = model.bias_sigma * model.bias_sigma;
  return {keep * bias.mean, keep * keep * bias.variance + (1.0 - keep * keep) * steady};
}

RangeBias corrected(const RangeBias& bias, const RangeTerm& term, const RangeSums& sums) {
  // term.sigma already holds the bias variance: S = sigma^2 + var(bias) + var(predicted distance)
  const double S = term.sigma * term.sigma + sums.predicted_variance;
  const double K = sums.inlier_share * bias.variance / S;
  return {bias.mean + K * (term.range - sums.predicted), (1.0 - K) * bias.variance};
}

AnchorTable::AnchorTable(const map::TunnelMap& map, const RangeLikelihood& model) : model_(model) {
  for (const map::Anchor& anchor : map.anchors) entries_[anchor.id] = Entry{anchor, {}, {}, {}};
  reset();
}

const AnchorTable::Entry* AnchorTable::find(AnchorId id) const {
  const auto found = entries_.find(id);
  return found == entries_.end() ? nullptr : &found->second;
}

RangeBias AnchorTable::biasAt(const Entry& entry, Stamp stamp) const {
  if (!entry.last || model_.bias_sigma <= 0.0) return entry.bias;
  return predicted(entry.bias, model_, seconds(stamp - *entry.last));
}

void AnchorTable::note(AnchorId id, Stamp stamp, double odometer, const RangeBias& bias) {
  Entry& entry = entries_.at(id);
  entry.bias = bias;
  entry.last = stamp;
  entry.odometer = odometer;
}

void AnchorTable::reset() {
  for (auto& [id, entry] : entries_) {
    entry.bias = {0.0, model_.bias_sigma * model_.bias_sigma};
    entry.last.reset();
    entry.odometer.reset();
  }
}

}  // namespace pos::estimation
