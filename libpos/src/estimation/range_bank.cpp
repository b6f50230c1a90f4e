#include "pos/estimation/range_bank.hpp"

#include <algorithm>
#include <cmath>

namespace pos::estimation {
namespace {

constexpr double kOutlierShare = 0.05;
constexpr double kOutlierDensity = 1.0 / 50.0;  // 1/m: a bad range may be anywhere over tens of metres
constexpr double kLost = -14.0;  // log of the weight, relative to the best, of a lost hypothesis

double logLikelihood(double nis, double variance) {
  const double good = std::exp(-0.5 * nis) / std::sqrt(2.0 * kPi * variance);
  return std::log((1.0 - kOutlierShare) * good + kOutlierShare * kOutlierDensity);
}

/// Two hypotheses are one when their poses differ by less than their own uncertainty.
bool twins(const RangeHypothesis& a, const RangeHypothesis& b) {
  const Matrix<3, 3> P =
      a.belief.covariance.topLeftCorner<3, 3>() + b.belief.covariance.topLeftCorner<3, 3>();
  const Vector<3> d = minus(a.belief.mean.pose(), b.belief.mean.pose());
  return d.dot(P.ldlt().solve(d)) < 0.1;
}

}  // namespace

RangeCorrection correctRange(RangeHypothesis& hypothesis, const RangeLayout& layout,
                             const RangeGeometry& geometry, double range, double variance,
                             filters::Gate gate) {
  const RangePrediction predicted =
      predictedRange(hypothesis.belief.mean, layout, hypothesis.belief.covariance, geometry);
  filters::Innovation<RangeState, 1> innovation;
  innovation.nu[0] = range - predicted.range - predicted.curvature_mean;
  innovation.H = predicted.H;
  const Matrix<1, 1> R(variance + predicted.curvature_variance);
  const RangeCorrection correction = filters::correct(hypothesis.belief, innovation, R, gate);
  if (correction.verdict != Verdict::Degenerate) {
    hypothesis.log_weight += logLikelihood(correction.nis, correction.S(0, 0));
  }
  return correction;
}

RangeBank::RangeBank(std::vector<RangeHypothesis> hypotheses) : hypotheses_(std::move(hypotheses)) {
  settle();
}

void RangeBank::settle() {
  if (hypotheses_.empty()) return;
  chooseBest();
  const double top = best().log_weight;
  for (RangeHypothesis& h : hypotheses_) h.log_weight -= top;
  if (hypotheses_.size() == 1) return;
  std::erase_if(hypotheses_, [](const RangeHypothesis& h) { return h.log_weight < kLost; });
  joinTwins();
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
      twin->log_weight = std::log(std::exp(twin->log_weight) + std::exp(candidate.log_weight));
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
