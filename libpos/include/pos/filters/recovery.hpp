#pragma once
/// When a particle filter notices that it is lost: augmented MCL (Thrun, Burgard, Fox 2005, table 8.3).

#include <algorithm>

namespace pos::filters {

/// A slow and a fast running mean of how likely the readings were. When the recent ones are much less likely
/// than the usual ones, a share of the particles should be drawn anew. Both means start at the first
/// likelihood (the table starts them at zero, which makes the share meaningless at first).
class LikelihoodAverages {
 public:
  /// Rates in (0, 1], slow <= fast; slow 0 switches the recovery off.
  LikelihoodAverages(double slow_rate, double fast_rate) : slow_rate_(slow_rate), fast_rate_(fast_rate) {}

  void add(double likelihood) {
    slow_ = started_ ? slow_ + slow_rate_ * (likelihood - slow_) : likelihood;
    fast_ = started_ ? fast_ + fast_rate_ * (likelihood - fast_) : likelihood;
    started_ = true;
  }

  /// max(0, 1 - fast / slow).
  double injectionShare() const {
    if (!started_ || slow_rate_ <= 0.0 || slow_ <= 0.0) return 0.0;
    return std::clamp(1.0 - fast_ / slow_, 0.0, 1.0);
  }
  bool started() const { return started_; }

 private:
  double slow_rate_;
  double fast_rate_;
  double slow_ = 0.0;
  double fast_ = 0.0;
  bool started_ = false;
};

}  // namespace pos::filters
