#include <algorithm>
#include <cmath>

#include "pos/core/square.hpp"
#include "pos/estimation/inertial_filters.hpp"

namespace pos::estimation {
namespace {

constexpr double kUnknownAcceleration = 1.0;  // m/s^2 sqrt(s), of a vehicle whose inertial unit is silent
constexpr double kUnknownTurn = 0.1;          // rad / sqrt(s)

}  // namespace

ins::EskfTransition coasting(double dt) {
  const Eigen::Matrix3d O = Eigen::Matrix3d::Zero();
  return {dt, O, O, O, Eigen::Matrix3d::Identity(), O};
}

Vector<15> coastingNoise(double dt) {
  Vector<15> q = Vector<15>::Zero();
  q.segment<3>(EskfState::kVelocity).setConstant(square(kUnknownAcceleration) * dt);
  q.segment<3>(EskfState::kAttitude).setConstant(square(kUnknownTurn) * dt);
  return q;
}

EskfFilter::EskfFilter(const Belief<EskfState>& start, const ins::EskfProcess& process, double /*spread*/)
    : belief_(start), process_(process), cross_(15, 0) {}

void EskfFilter::propagate(const ins::ImuIncrement& raw) {
  if (raw.dt == 0.0) return;
  const ins::EskfStep step = ins::stepped(belief_.mean, raw, process_.gravity);
  belief_.mean = step.next;
  ins::carry(belief_.covariance, step.F, ins::processNoise(process_, raw.dt));
  if (anchors_.empty()) return;
  const double keep = std::exp(-raw.dt / bias_time_);
  cross_ = keep * step.F.carried(cross_);
  bias_ *= keep;
  bias_P_ *= keep * keep;
  bias_P_.diagonal().array() += (1.0 - keep * keep) * square(bias_sigma_);
}

void EskfFilter::coast(double dt) {
  const ins::EskfTransition F = coasting(dt);
  belief_.mean.p_map += dt * belief_.mean.v_map;
  ins::carry(belief_.covariance, F, coastingNoise(dt));
  if (!anchors_.empty()) cross_ = F.carried(cross_);
}

SequentialCorrection::Expected EskfFilter::expected(const RangeLink& link) const {
  const RangeSeen seen = seenRange(belief_.mean, link.lever, link.anchor_map, link.range);
  const TangentRows<EskfState, 1> H = seen.row.dense();
  SequentialCorrection::Expected told{seen.row.nu, H * belief_.covariance * H.transpose()};
  const int i = indexOf(link.anchor);
  if (i < 0) return told;
  told.nu -= bias_[i];
  told.variance += 2.0 * (H * cross_.col(i))(0) + bias_P_(i, i);
  return told;
}

filters::Correction<1> EskfFilter::take(const RangeLink& link, double R) {
  RangeSeen seen = seenRange(belief_.mean, link.lever, link.anchor_map, link.range);
  if (anchors_.empty()) {
    SequentialCorrection sequential(belief_);
    const auto told = sequential.take(seen.row, R);
    if (told.verdict == Verdict::Applied) belief_ = sequential.injected();
    return told;
  }
  Eigen::Matrix<double, 1, Eigen::Dynamic> H_bias =
      Eigen::Matrix<double, 1, Eigen::Dynamic>::Zero(1, bias_.size());
  if (const int i = indexOf(link.anchor); i >= 0) {
    seen.row.nu -= bias_[i];
    H_bias[i] = 1.0;
  }
  return correctJoint<1>({Vector<1>(seen.row.nu), seen.row.dense()}, H_bias, Matrix<1, 1>(R), {});
}

int EskfFilter::indexOf(int anchor) const {
  const auto found = std::find(anchors_.begin(), anchors_.end(), anchor);
  return found == anchors_.end() ? -1 : static_cast<int>(found - anchors_.begin());
}

std::vector<EskfFilter::AnchorBias> EskfFilter::biases() const {
  std::vector<AnchorBias> list;
  for (std::size_t k = 0; k < anchors_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    list.push_back({anchors_[k], bias_[i], std::sqrt(std::max(0.0, bias_P_(i, i)))});
  }
  return list;
}

void EskfFilter::addBias(int anchor, double sigma, double time) {
  if (indexOf(anchor) >= 0) return;
  bias_sigma_ = sigma;
  bias_time_ = time;
  anchors_.push_back(anchor);
  const auto n = static_cast<Eigen::Index>(anchors_.size());
  cross_.conservativeResize(15, n);
  cross_.col(n - 1).setZero();
  bias_.conservativeResize(n);
  bias_[n - 1] = 0.0;
  bias_P_.conservativeResize(n, n);
  bias_P_.row(n - 1).setZero();
  bias_P_.col(n - 1).setZero();
  bias_P_(n - 1, n - 1) = square(sigma);
}

void EskfFilter::dropBias(int anchor) {
  const int i = indexOf(anchor);
  if (i < 0) return;
  // The last one takes its place.
  const auto last = static_cast<Eigen::Index>(anchors_.size()) - 1;
  anchors_[static_cast<std::size_t>(i)] = anchors_.back();
  anchors_.pop_back();
  bias_[i] = bias_[last];
  cross_.col(i) = cross_.col(last).eval();
  bias_P_.row(i) = bias_P_.row(last).eval();
  bias_P_.col(i) = bias_P_.col(last).eval();
  bias_P_(i, i) = bias_P_(last, last);
  bias_.conservativeResize(last);
  cross_.conservativeResize(15, last);
  bias_P_.conservativeResize(last, last);
}

}  // namespace pos::estimation
