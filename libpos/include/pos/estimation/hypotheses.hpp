#pragma once
/// Beliefs side by side about where the vehicle is, kept until one wins.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "pos/core/belief.hpp"
#include "pos/core/pose2.hpp"

namespace pos::estimation {

/// log(e^a + e^b).
inline double logSum(double a, double b) {
  const double top = std::max(a, b);
  return top + std::log1p(std::exp(std::min(a, b) - top));
}

/// How likely a range is that a filter expected with variance S: a Gaussian plus a share of bad ranges, so
/// that one bad range cannot kill a good hypothesis.
namespace likelihood {
inline constexpr double kOutlierShare = 0.05;
inline constexpr double kOutlierDensity = 1.0 / 50.0;  // 1/m: a bad range may be anywhere over tens of metres

inline double logOfGood(double nis, double S) {
  return std::log(1.0 - kOutlierShare) - 0.5 * nis - 0.5 * std::log(2.0 * kPi * S);
}
inline double logOfOutlier() {
  return std::log(kOutlierShare * kOutlierDensity);
}
}  // namespace likelihood

/// One belief with the logarithm of its weight.
template <class State>
struct Hypothesis {
  Belief<State> belief;
  double log_weight = 0.0;
};

/// A bank of hypotheses; the best one's weight is 1 once settled. `State` has a pose().
template <class State>
class HypothesisBank {
 public:
  static constexpr std::size_t kMost = 32;  ///< kept at the same time
  static constexpr double kLost = -14.0;    ///< log of the weight, relative to the best, of a lost hypothesis
  static constexpr double kTwins = 0.1;     ///< squared sigmas between two that have become one

  HypothesisBank() = default;
  explicit HypothesisBank(std::vector<Hypothesis<State>> hypotheses) : hypotheses_(std::move(hypotheses)) {
    settle();
  }

  bool empty() const { return hypotheses_.empty(); }
  std::size_t size() const { return hypotheses_.size(); }
  std::vector<Hypothesis<State>>& hypotheses() { return hypotheses_; }
  const std::vector<Hypothesis<State>>& hypotheses() const { return hypotheses_; }
  std::size_t bestIndex() const { return best_; }
  const Hypothesis<State>& best() const { return hypotheses_[best_]; }

  /// Weights that sum to one, in order.
  std::vector<double> weights() const {
    std::vector<double> weights;
    double sum = 0.0;
    for (const auto& h : hypotheses_) sum += weights.emplace_back(std::exp(h.log_weight));
    for (double& weight : weights) weight /= sum;
    return weights;
  }

  /// Drops those that are not possible, unless none would remain: then the judge is wrong, not the filter.
  template <class Possible>
  void keep(const Possible& possible) {
    if (hypotheses_.size() < 2 || std::none_of(hypotheses_.begin(), hypotheses_.end(), possible)) return;
    std::erase_if(hypotheses_, [&](const Hypothesis<State>& h) { return !possible(h); });
  }

  /// Normalises the weights, drops hypotheses that have lost, joins those that have become one, keeps the
  /// likeliest `kMost`, and finds the best. To be called whenever weights or hypotheses have changed.
  void settle() {
    chooseBest();
    if (empty()) return;
    const double top = best().log_weight;
    for (auto& h : hypotheses_) h.log_weight -= top;
    if (size() == 1) return;
    std::erase_if(hypotheses_, [](const Hypothesis<State>& h) { return h.log_weight < kLost; });
    joinTwins();
    if (size() > kMost) hypotheses_.resize(kMost);  // sorted by weight: the least likely go
    chooseBest();
  }

 private:
  static bool lighter(const Hypothesis<State>& a, const Hypothesis<State>& b) {
    return a.log_weight < b.log_weight;
  }

  static bool twins(const Hypothesis<State>& a, const Hypothesis<State>& b) {
    const Matrix<3, 3> P = a.belief.covariance.template topLeftCorner<3, 3>() +
                           b.belief.covariance.template topLeftCorner<3, 3>();
    const Vector<3> d = minus(a.belief.mean.pose(), b.belief.mean.pose());
    return d.dot(P.ldlt().solve(d)) < kTwins;
  }

  void joinTwins() {
    std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                     [](const auto& a, const auto& b) { return lighter(b, a); });
    std::vector<Hypothesis<State>> kept;
    for (auto& candidate : hypotheses_) {
      const auto twin =
          std::find_if(kept.begin(), kept.end(), [&](const auto& k) { return twins(k, candidate); });
      if (twin == kept.end()) {
        kept.push_back(std::move(candidate));
      } else {
        twin->log_weight = logSum(twin->log_weight, candidate.log_weight);
      }
    }
    hypotheses_ = std::move(kept);
  }

  void chooseBest() {
    best_ = static_cast<std::size_t>(std::max_element(hypotheses_.begin(), hypotheses_.end(), lighter) -
                                     hypotheses_.begin());
  }

  std::vector<Hypothesis<State>> hypotheses_;
  std::size_t best_ = 0;
};

}  // namespace pos::estimation
