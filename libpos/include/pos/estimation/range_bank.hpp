#pragma once
/// Several beliefs about where the vehicle is, kept until one wins.

#include <vector>

#include "pos/core/belief.hpp"
#include "pos/estimation/range_models.hpp"

namespace pos::estimation {

/// One belief with the logarithm of its weight.
struct RangeHypothesis {
  Belief<RangeState> belief;
  double log_weight = 0.0;
};

/// What a range did to the best hypothesis.
using RangeCorrection = filters::Correction<1>;

/// Corrects one hypothesis by one range and adds the range's likelihood to its weight. The likelihood is a
/// Gaussian plus a share of outliers, so that one bad range cannot kill a good hypothesis. `variance` in m^2,
/// gate on nis.
RangeCorrection correctRange(RangeHypothesis& hypothesis, const RangeLayout& layout,
                             const RangeGeometry& geometry, double range, double variance,
                             filters::Gate gate);

/// A bank of hypotheses; never empty once started.
class RangeBank {
 public:
  RangeBank() = default;
  explicit RangeBank(std::vector<RangeHypothesis> hypotheses);

  bool empty() const { return hypotheses_.empty(); }
  std::size_t size() const { return hypotheses_.size(); }
  const RangeHypothesis& best() const { return hypotheses_[best_]; }
  std::vector<RangeHypothesis>& hypotheses() { return hypotheses_; }
  const std::vector<RangeHypothesis>& hypotheses() const { return hypotheses_; }

  /// Normalises the weights, drops hypotheses that have lost (weight below e^-14 of the best) and joins those
  /// that have become one, then chooses the best. Call after every round of corrections.
  void settle();

  /// Weights that sum to one, in order.
  std::vector<double> weights() const;

 private:
  void joinTwins();
  void chooseBest();
  std::vector<RangeHypothesis> hypotheses_;
  std::size_t best_ = 0;
};

}  // namespace pos::estimation
