#include "pos/estimation/dual_uwb_bank.hpp"

#include <Eigen/Cholesky>

namespace pos::estimation {
namespace {

constexpr double kLost = -14.0;  // log weight, relative to the best, of a lost hypothesis
constexpr double kTwins = 0.01;  // squared sigmas apart below which two are one

bool heavier(const DualUwbHypothesis& a, const DualUwbHypothesis& b) {
  return a.log_weight < b.log_weight;
}

bool twins(const DualUwbHypothesis& a, const DualUwbHypothesis& b) {
  const Vector<3> apart = minus(a.belief.mean.pose(), b.belief.mean.pose());
  const Matrix<3, 3> P = a.belief.covariance.topLeftCorner<3, 3>();
  return apart.dot(P.ldlt().solve(apart)) < kTwins;
}

}  // namespace

void DualUwbBank::settle() {
  best_ = 0;
  if (hypotheses_.size() < 2) return;
  const double top = std::max_element(hypotheses_.begin(), hypotheses_.end(), heavier)->log_weight;
  std::erase_if(hypotheses_, [&](const DualUwbHypothesis& h) { return h.log_weight < top + kLost; });
  for (DualUwbHypothesis& h : hypotheses_) h.log_weight -= top;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    for (std::size_t j = hypotheses_.size() - 1; j > i; --j) {
      if (twins(hypotheses_[i], hypotheses_[j]))
        hypotheses_.erase(hypotheses_.begin() + static_cast<long>(j));
    }
  }
  best_ = static_cast<std::size_t>(std::max_element(hypotheses_.begin(), hypotheses_.end(), heavier) -
                                   hypotheses_.begin());
}

Matrix<3, 3> spreadAbout(const Pose2& best, const Belief<Pose2>& part, double weight) {
  const Vector<3> apart = minus(part.mean, best);
  Matrix<3, 3> spread = part.covariance;
  spread.topLeftCorner<2, 2>() += apart.head<2>() * apart.head<2>().transpose();
  spread(2, 2) += apart[2] * apart[2];
  return weight * spread;
}

}  // namespace pos::estimation
