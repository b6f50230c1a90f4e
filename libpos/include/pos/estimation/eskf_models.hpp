#pragma once
/// What sensors say about the state of an error-state filter (J. China Coal Soc. 2024, doi
/// 10.13225/j.cnki.jccs.2024.0676; docs/math/eskf.md). Pure functions; every H is by the error, nu = reading
/// minus prediction. Lever arms are in body axes from the inertial unit, m.

#include "pos/core/pose3.hpp"
#include "pos/filters/ekf.hpp"
#include "pos/ins/eskf.hpp"

namespace pos::estimation {

using ins::EskfState;

/// A scalar reading that depends on where the unit is and how it stands, and on nothing else.
struct PoseRow {
  double nu = 0.0;
  Eigen::Vector3d by_position = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_attitude = Eigen::Vector3d::Zero();

  TangentRows<EskfState, 1> dense() const;
};

/// A range ready for a filter.
struct RangeLink {
  Eigen::Vector3d lever = Eigen::Vector3d::Zero();       ///< m, tag from the inertial unit, body axes
  Eigen::Vector3d anchor_map = Eigen::Vector3d::Zero();  ///< m
  int anchor = 0;                                        ///< which one: the filter's number for it
  double range = 0.0;                                    ///< m
};

/// A range to an anchor seen from the state: h = |p + R l - s|.
struct RangeSeen {
  double distance = 0.0;  ///< m, predicted
  PoseRow row;            ///< nu as the range was given
};
/// `range` (m) from the tag at `lever` to the anchor. The row means nothing within kNearestAnchor of it.
RangeSeen seenRange(const EskfState& x, const Eigen::Vector3d& lever, const Eigen::Vector3d& anchor_map,
                    double range);
inline RangeSeen seenRange(const EskfState& x, const RangeLink& link) {
  return seenRange(x, link.lever, link.anchor_map, link.range);
}
inline constexpr double kNearestAnchor = 0.2;  ///< m

/// A fix of the point at `lever`: an antenna's, or a tag's from multilateration. Map axes, m.
filters::Innovation<EskfState, 3> pointFix(const EskfState& x, const Eigen::Vector3d& p_map,
                                           const Eigen::Vector3d& lever);
/// Velocity of the point at `lever`, map axes, m/s. `gyro` is the unit's reading, rad/s, bias and all.
filters::Innovation<EskfState, 3> pointVelocity(const EskfState& x, const Eigen::Vector3d& v_map,
                                                const Eigen::Vector3d& lever, const Eigen::Vector3d& gyro);
/// Height of the point at `lever` is `z` (m, map).
filters::Innovation<EskfState, 1> pointHeight(const EskfState& x, double z, const Eigen::Vector3d& lever);
/// The unit stands still (ZUPT).
filters::Innovation<EskfState, 3> atRest(const EskfState& x);
/// It does not turn (ZARU): `mean_gyro` is what the gyros read, rad/s.
filters::Innovation<EskfState, 3> notTurning(const EskfState& x, const Eigen::Vector3d& mean_gyro);
/// The point at `lever`, on an axle that does not steer, moves neither sideways nor upward.
filters::Innovation<EskfState, 2> noSideSlip(const EskfState& x, const Eigen::Vector3d& lever,
                                             const Eigen::Vector3d& gyro);
/// Wheels carry the point at `lever` forward with `speed`, m/s.
filters::Innovation<EskfState, 1> wheelSpeed(const EskfState& x, double speed, const Eigen::Vector3d& lever,
                                             const Eigen::Vector3d& gyro);
/// Heading of the body's x axis seen from above, rad.
filters::Innovation<EskfState, 1> heading(const EskfState& x, double yaw);

/// filters::correct, and the reset that belongs to the injection: the covariance's attitude turned by
/// J_r(dtheta).
template <int M>
filters::Correction<M> correctError(Belief<EskfState>& belief,
                                    const filters::Innovation<EskfState, M>& innovation,
                                    const Matrix<M, M>& R, filters::Gate gate = {}) {
  const Eigen::Quaterniond before = belief.mean.q_map_body;
  filters::Correction<M> told = filters::correct(belief, innovation, R, gate);
  if (told.verdict == Verdict::Applied) {
    const Eigen::Vector3d turned = rotationVector(before.conjugate() * belief.mean.q_map_body);
    ins::turnAttitude(belief.covariance, ins::rightJacobian(turned));
  }
  return told;
}

/// H P H' of a row.
double varianceSeen(const Matrix<15, 15>& P, const PoseRow& row);

/// Scalar readings of one moment, one after the other, linearised about one state: the innovations are
/// corrected by the error found so far, and the error is injected once (section A4 of the specification).
/// Equal to one stacked correction; the rows' zeros cost nothing (bench/eskf).
class SequentialCorrection {
 public:
  explicit SequentialCorrection(const Belief<EskfState>& at) : at_(at) { d_.setZero(); }

  /// Where rows are linearised.
  const EskfState& state() const { return at_.mean; }
  /// What a row would meet: nu corrected by the error so far, S without the reading's noise.
  struct Expected {
    double nu = 0.0;
    double variance = 0.0;  ///< H P H'
  };
  Expected expected(const PoseRow& row) const;
  /// Takes the row with variance R; gated as filters::correct does.
  filters::Correction<1> take(const PoseRow& row, double R, filters::Gate gate = {});
  /// The belief with the error injected and the covariance reset.
  Belief<EskfState> injected() const;
  /// The covariance before the reset.
  const Matrix<15, 15>& covariance() const { return at_.covariance; }

 private:
  double innovation(const PoseRow& row) const;

  Belief<EskfState> at_;
  Vector<15> d_;
};

}  // namespace pos::estimation
