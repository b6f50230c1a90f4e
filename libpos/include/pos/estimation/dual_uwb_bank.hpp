#pragma once
/// Beliefs side by side while mirror images, or whole headings, cannot be told apart.

#include <algorithm>
#include <vector>

#include "pos/estimation/dual_uwb_models.hpp"

namespace pos::estimation {

/// One belief about the vehicle and the log of its likelihood.
struct DualUwbHypothesis {
  Belief<DualUwbState> belief;
  double log_weight = 0.0;
};

class DualUwbBank {
 public:
  DualUwbBank() = default;
  explicit DualUwbBank(std::vector<DualUwbHypothesis> hypotheses) : hypotheses_(std::move(hypotheses)) {}

  bool empty() const { return hypotheses_.empty(); }
  std::size_t size() const { return hypotheses_.size(); }
  std::vector<DualUwbHypothesis>& hypotheses() { return hypotheses_; }
  const std::vector<DualUwbHypothesis>& hypotheses() const { return hypotheses_; }
  std::size_t bestIndex() const { return best_; }
  const DualUwbHypothesis& best() const { return hypotheses_[best_]; }

  /// Drops those that are not possible, unless none would remain: then the judge is wrong, not the filter.
  template <class Possible>
  void keep(const Possible& possible) {
    if (hypotheses_.size() < 2 || std::none_of(hypotheses_.begin(), hypotheses_.end(), possible)) return;
    std::erase_if(hypotheses_, [&](const DualUwbHypothesis& h) { return !possible(h); });
  }
  /// Drops the lost, joins twins, finds the best.
  void settle();

 private:
  std::vector<DualUwbHypothesis> hypotheses_;
  std::size_t best_ = 0;
};

/// Covariance about `best` of a mixture: to be summed over its parts, weights adding to one. Position and
/// heading spread apart from each other, since a heading that may be the opposite one has no sign.
Matrix<3, 3> spreadAbout(const Pose2& best, const Belief<Pose2>& part, double weight);

}  // namespace pos::estimation
