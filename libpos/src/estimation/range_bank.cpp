#include "pos/estimation/range_bank.hpp"

#include <algorithm>
#include <cmath>

namespace pos::estimation {
namespace {

constexpr double kOutlierShare = 0.05;
constexpr double kOutlierDensity = 1.0 / 50.0;  // 1/m: a bad range may be anywhere over tens of metres
constexpr std::size_t kMost = 32;               // hypotheses kept at the same time
constexpr double kConsequential = 0.5;          // square of the sigmas moved from which a range is doubted
constexpr double kLost = -14.0;  // log of the weight, relative to the best, of a lost hypothesis

double logOfGood(double nis, double variance) {
  return std::log(1.0 - kOutlierShare) - 0.5 * nis - 0.5 * std::log(2.0 * kPi * variance);
}
const double kLogOfOutlier = std::log(kOutlierShare * kOutlierDensity);

double logSum(double a, double b) {
  const double top = std::max(a, b);
  return top + std::log1p(std::exp(std::min(a, b) - top));
}

struct Corrected {
  Belief<RangeState> belief;
  RangeCorrection correction;
  double variance = 0.0;  ///< m^2, of the range with the curvature's share
};

Corrected corrected(Belief<RangeState> belief, const RangeLayout& layout, const RangeReading& reading,
                    filters::Gate gate) {
  const RangePrediction predicted = predictedRange(belief.mean, layout, belief.covariance, reading.geometry);
  filters::Innovation<RangeState, 1> innovation;
  innovation.nu[0] = reading.range - predicted.range - predicted.curvature_mean;
  innovation.H = predicted.H;
  const double variance = reading.variance + predicted.curvature_variance;
  const RangeCorrection correction = filters::correct(belief, innovation, Matrix<1, 1>(variance), gate);
  return {std::move(belief), correction, variance};
}

/// Believing the range moves the state by a good part of its own uncertainty: if the range was bad, the harm
/// is done. The square of that part is nu' K' P^-1 K nu = nis * (H P H') / S.
bool consequential(const Corrected& c) {
  const double share_of_state = 1.0 - c.variance / c.correction.S(0, 0);
  return c.correction.verdict == Verdict::Applied && c.correction.nis * share_of_state > kConsequential;
}

/// Two hypotheses are one when their poses differ by less than their own uncertainty.
bool twins(const RangeHypothesis& a, const RangeHypothesis& b) {
  const Matrix<3, 3> P =
      a.belief.covariance.topLeftCorner<3, 3>() + b.belief.covariance.topLeftCorner<3, 3>();
  const Vector<3> d = minus(a.belief.mean.pose(), b.belief.mean.pose());
  return d.dot(P.ldlt().solve(d)) < 0.1;
}

}  // namespace

RangeBank::RangeBank(std::vector<RangeHypothesis> hypotheses) : hypotheses_(std::move(hypotheses)) {
  settle();
}

RangeCorrection RangeBank::correct(const RangeLayout& layout, const RangeReading& reading,
                                   filters::Gate gate) {
  RangeCorrection told;
  std::vector<RangeHypothesis> doubters;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    RangeHypothesis& h = hypotheses_[i];
    Corrected c = corrected(h.belief, layout, reading, gate);
    if (i == best_) told = c.correction;
    if (c.correction.verdict == Verdict::Degenerate) continue;
    const double good = logOfGood(c.correction.nis, c.correction.S(0, 0));
    if (consequential(c)) {
      doubters.push_back({h.belief, h.log_weight + kLogOfOutlier});
      h.log_weight += good;
    } else {
      h.log_weight += logSum(good, kLogOfOutlier);
    }
    h.belief = std::move(c.belief);
  }
  hypotheses_.insert(hypotheses_.end(), doubters.begin(), doubters.end());
  settle();
  return told;
}

void RangeBank::settle() {
  if (hypotheses_.empty()) return;
  chooseBest();
  const double top = best().log_weight;
  for (RangeHypothesis& h : hypotheses_) h.log_weight -= top;
  if (hypotheses_.size() == 1) return;
  std::erase_if(hypotheses_, [](const RangeHypothesis& h) { return h.log_weight < kLost; });
  joinTwins();
  if (hypotheses_.size() > kMost) hypotheses_.resize(kMost);  // sorted by weight: the least likely go
  chooseBest();
}

std::vector<double> RangeBank::weights() const {
  std::vector<double> weights;
  double sum = 0.0;
  for (const RangeHypothesis& h : hypotheses_) sum += weights.emplace_back(std::exp(h.log_weight));
  for (double& weight : weights) weight /= sum;
  return weights;
}

void RangeBank::joinTwins() {
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [](const auto& a, const auto& b) { return a.log_weight > b.log_weight; });
  std::vector<RangeHypothesis> kept;
  for (const RangeHypothesis& candidate : hypotheses_) {
    const auto twin =
        std::find_if(kept.begin(), kept.end(), [&](const auto& k) { return twins(k, candidate); });
    if (twin == kept.end()) {
      kept.push_back(candidate);
    } else {
      twin->log_weight = logSum(twin->log_weight, candidate.log_weight);
    }
  }
  hypotheses_ = std::move(kept);
}

void RangeBank::chooseBest() {
  const auto best =
      std::max_element(hypotheses_.begin(), hypotheses_.end(),
                       [](const auto& a, const auto& b) { return a.log_weight < b.log_weight; });
  best_ = static_cast<std::size_t>(best - hypotheses_.begin());
}

}  // namespace pos::estimation
