#include "pos/estimation/range_offsets.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/square.hpp"

namespace pos::estimation {

template <int M>
filters::Correction<M> RangeOffsets::correctJoint(Belief<EskfState>& belief,
                                                  const filters::Innovation<EskfState, M>& innovation,
                                                  const Rows<M>& H_offset, const Matrix<M, M>& R,
                                                  filters::Gate gate) {
  const Eigen::Matrix<double, 15, M> G =
      belief.covariance * innovation.H.transpose() + cross_ * H_offset.transpose();
  const Eigen::Matrix<double, Eigen::Dynamic, M> G_offset =
      cross_.transpose() * innovation.H.transpose() + covariance_ * H_offset.transpose();
  auto told = judged<M>(innovation.nu, innovation.H * G + H_offset * G_offset + R, gate);
  if (told.verdict != Verdict::Applied) return told;
  const Eigen::LLT<Matrix<M, M>> S(told.S);
  const Eigen::Matrix<double, 15, M> K = S.solve(G.transpose()).transpose();
  const Eigen::Matrix<double, Eigen::Dynamic, M> K_offset = S.solve(G_offset.transpose()).transpose();
  const Vector<15> d = K * told.nu;
  belief.mean = plus(belief.mean, d);
  mean_ += K_offset * told.nu;
  belief.covariance -= K * G.transpose();
  cross_ -= K * G_offset.transpose();
  covariance_ -= K_offset * G_offset.transpose();
  filters::symmetrise(belief.covariance);
  filters::symmetrise(covariance_);
  const Eigen::Matrix3d turned = ins::rightJacobian(d.segment<3>(EskfState::kAttitude));
  ins::turnAttitude(belief.covariance, turned);
  cross_.middleRows<3>(EskfState::kAttitude) = (turned * cross_.middleRows<3>(EskfState::kAttitude)).eval();
  return told;
}

template <int M>
filters::Correction<M> RangeOffsets::correct(Belief<EskfState>& belief,
                                             const filters::Innovation<EskfState, M>& innovation,
                                             const Matrix<M, M>& R, filters::Gate gate) {
  if (none()) return correctError<M>(belief, innovation, R, gate);
  return correctJoint<M>(belief, innovation, Rows<M>::Zero(M, mean_.size()), R, gate);
}

// All that is asked for: one range, a pair, a point.
template filters::Correction<1> RangeOffsets::correct<1>(Belief<EskfState>&,
                                                         const filters::Innovation<EskfState, 1>&,
                                                         const Matrix<1, 1>&, filters::Gate);
template filters::Correction<2> RangeOffsets::correct<2>(Belief<EskfState>&,
                                                         const filters::Innovation<EskfState, 2>&,
                                                         const Matrix<2, 2>&, filters::Gate);
template filters::Correction<3> RangeOffsets::correct<3>(Belief<EskfState>&,
                                                         const filters::Innovation<EskfState, 3>&,
                                                         const Matrix<3, 3>&, filters::Gate);

int RangeOffsets::indexOf(int anchor) const {
  const auto found = std::find(anchors_.begin(), anchors_.end(), anchor);
  return found == anchors_.end() ? -1 : static_cast<int>(found - anchors_.begin());
}

std::vector<RangeOffsets::Offset> RangeOffsets::list() const {
  std::vector<Offset> all;
  for (std::size_t k = 0; k < anchors_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    all.push_back({anchors_[k], mean_[i], std::sqrt(std::max(0.0, covariance_(i, i)))});
  }
  return all;
}

void RangeOffsets::add(int anchor, const AnchorBiasConfig& config) {
  if (has(anchor)) return;
  sigma_ = config.sigma;
  time_ = config.time;
  anchors_.push_back(anchor);
  const auto n = static_cast<Eigen::Index>(anchors_.size());
  cross_.conservativeResize(15, n);
  cross_.col(n - 1).setZero();
  mean_.conservativeResize(n);
  mean_[n - 1] = 0.0;
  covariance_.conservativeResize(n, n);
  covariance_.row(n - 1).setZero();
  covariance_.col(n - 1).setZero();
  covariance_(n - 1, n - 1) = square(sigma_);
}

void RangeOffsets::drop(int anchor) {
  const int i = indexOf(anchor);
  if (i < 0) return;
  // The last one takes its place.
  const auto last = static_cast<Eigen::Index>(anchors_.size()) - 1;
  anchors_[static_cast<std::size_t>(i)] = anchors_.back();
  anchors_.pop_back();
  mean_[i] = mean_[last];
  cross_.col(i) = cross_.col(last).eval();
  covariance_.row(i) = covariance_.row(last).eval();
  covariance_.col(i) = covariance_.col(last).eval();
  covariance_(i, i) = covariance_(last, last);
  mean_.conservativeResize(last);
  cross_.conservativeResize(15, last);
  covariance_.conservativeResize(last, last);
}

void RangeOffsets::propagate(Belief<EskfState>& belief, const ins::ImuIncrement& raw,
                             const ins::EskfProcess& process) {
  if (none()) return ins::propagate(belief, raw, process);
  if (raw.dt == 0.0) return;
  const ins::EskfStep step = ins::stepped(belief.mean, raw, process.gravity);
  belief.mean = step.next;
  ins::carry(belief.covariance, step.F, ins::processNoise(process, raw.dt));
  carry(step.F);
}

void RangeOffsets::carry(const ins::EskfTransition& F) {
  if (none()) return;
  const double keep = std::exp(-F.dt / time_);
  cross_ = keep * F.carried(cross_);
  mean_ *= keep;
  covariance_ *= keep * keep;
  covariance_.diagonal().array() += (1.0 - keep * keep) * square(sigma_);
}

SequentialCorrection::Expected RangeOffsets::expected(const Belief<EskfState>& belief, const PoseRow& row,
                                                      int anchor) const {
  SequentialCorrection::Expected told{row.nu, varianceSeen(belief.covariance, row)};
  const int i = indexOf(anchor);
  if (i < 0) return told;
  told.nu -= mean_[i];
  told.variance += 2.0 * (row.dense() * cross_.col(i))(0) + covariance_(i, i);
  return told;
}

filters::Correction<1> RangeOffsets::take(Belief<EskfState>& belief, PoseRow row, int anchor, double R) {
  if (none()) {
    SequentialCorrection sequential(belief);
    auto told = sequential.take(row, R);
    if (told.verdict == Verdict::Applied) belief = sequential.injected();
    return told;
  }
  Rows<1> H_offset = Rows<1>::Zero(1, mean_.size());
  if (const int i = indexOf(anchor); i >= 0) {
    row.nu -= mean_[i];
    H_offset[i] = 1.0;
  }
  return correctJoint<1>(belief, {Vector<1>(row.nu), row.dense()}, H_offset, Matrix<1, 1>(R), {});
}

void AnchorDoubts::note(const AnchorBiasConfig& config, Stamp stamp, int anchor, bool doubtful,
                        RangeOffsets& offsets) {
  if (!(config.sigma > 0.0)) return;
  Lately& lately = lately_[anchor];
  if (doubtful) {
    lately.good_since.reset();
    if (!lately.doubtful_since) lately.doubtful_since = stamp;
    if (seconds(stamp - *lately.doubtful_since) > config.after) offsets.add(anchor, config);
    return;
  }
  lately.doubtful_since.reset();
  if (!lately.good_since) lately.good_since = stamp;
  if (seconds(stamp - *lately.good_since) > config.drop_after) offsets.drop(anchor);
}

}  // namespace pos::estimation
