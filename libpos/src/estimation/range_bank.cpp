#include "pos/estimation/range_bank.hpp"

#include <algorithm>
#include <cmath>

namespace pos::estimation {
namespace {

constexpr double kConsequential = 0.5;  // square of the sigmas moved from which a range is doubted

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

}  // namespace

RangeCorrection RangeBank::correct(const RangeLayout& layout, const RangeReading& reading,
                                   filters::Gate gate) {
  RangeCorrection told;
  std::vector<RangeHypothesis> doubters;
  for (std::size_t i = 0; i < size(); ++i) {
    RangeHypothesis& h = hypotheses()[i];
    Corrected c = corrected(h.belief, layout, reading, gate);
    if (i == bestIndex()) told = c.correction;
    if (c.correction.verdict == Verdict::Degenerate) continue;
    const double good = likelihood::logOfGood(c.correction.nis, c.correction.S(0, 0));
    if (consequential(c)) {
      doubters.push_back({h.belief, h.log_weight + likelihood::logOfOutlier()});
      h.log_weight += good;
    } else {
      h.log_weight += logSum(good, likelihood::logOfOutlier());
    }
    h.belief = std::move(c.belief);
  }
  hypotheses().insert(hypotheses().end(), doubters.begin(), doubters.end());
  settle();
  return told;
}

}  // namespace pos::estimation
