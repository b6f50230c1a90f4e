#include "pos/estimation/wheel_heading.hpp"

#include <cmath>

#include "pos/core/angle.hpp"
#include "pos/core/pose3.hpp"
#include "pos/core/square.hpp"

namespace pos::estimation {
namespace {

/// d sinc(turn / 2) / d turn.
double sincSlope(double turn) {
  const double u = 0.5 * turn;
  return 0.5 * (std::abs(u) < 1e-2 ? -u / 3.0 + u * u * u / 30.0 : (std::cos(u) - ins::sinc(u)) / u);
}

/// The arc of one reading and its derivatives.
struct Arc {
  double turn;              ///< rad, of the vehicle
  Eigen::Vector3d moved;    ///< m
  Eigen::Vector3d by_way;   ///< per m of the middle
  Eigen::Vector3d by_turn;  ///< m per rad turned
  Eigen::Vector3d by_yaw;   ///< m per rad of heading
  Eigen::Vector3d by_climb;
};

Arc arcOf(const WheelHeading& x, const ins::WheelWay& way, double track) {
  Arc arc;
  arc.turn = (1.0 - x.track_error) * way.turn(track);
  const double middle = x.yaw + 0.5 * arc.turn;
  const double c = std::cos(x.climb);
  const Eigen::Vector3d along(c * std::cos(middle), c * std::sin(middle), std::sin(x.climb));
  const Eigen::Vector3d left(-c * std::sin(middle), c * std::cos(middle), 0.0);
  const double sinc = ins::sinc(0.5 * arc.turn);
  arc.moved = way.middle() * sinc * along;
  arc.by_way = sinc * along;
  arc.by_yaw = way.middle() * sinc * left;
  arc.by_turn = way.middle() * sincSlope(arc.turn) * along + 0.5 * arc.by_yaw;
  arc.by_climb = way.middle() * sinc *
                 Eigen::Vector3d(-std::sin(x.climb) * std::cos(middle), -std::sin(x.climb) * std::sin(middle),
                                 std::cos(x.climb));
  return arc;
}

}  // namespace

Eigen::Quaterniond WheelHeading::rotation() const {
  return Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, yaw, -climb, roll).rotation;
}

WheelHeading plus(const WheelHeading& x, const Tangent<WheelHeading>& d) {
  WheelHeading next = x;
  next.p_map += d.segment<3>(kAxle);
  next.climb += d[kClimb];
  next.roll = wrapAngle(x.roll + d[kRoll]);
  next.yaw = wrapAngle(x.yaw + d[kYaw]);
  next.yaw_bias += d[kYawBias];
  next.track_error += d[kTrackError];
  return next;
}

Tangent<WheelHeading> minus(const WheelHeading& to, const WheelHeading& from) {
  Tangent<WheelHeading> d;
  d.segment<3>(kAxle) = to.p_map - from.p_map;
  d[kClimb] = to.climb - from.climb;
  d[kRoll] = wrapAngle(to.roll - from.roll);
  d[kYaw] = wrapAngle(to.yaw - from.yaw);
  d[kYawBias] = to.yaw_bias - from.yaw_bias;
  d[kTrackError] = to.track_error - from.track_error;
  return d;
}

Matrix<8, 2> wayGain(const WheelHeading& x, const ins::WheelWay& way, double track) {
  const Arc arc = arcOf(x, way, track);
  const double turn_per_way = (1.0 - x.track_error) / track;
  Matrix<8, 2> G = Matrix<8, 2>::Zero();
  G.block<3, 1>(kAxle, 0) = 0.5 * arc.by_way - turn_per_way * arc.by_turn;
  G.block<3, 1>(kAxle, 1) = 0.5 * arc.by_way + turn_per_way * arc.by_turn;
  G(kYaw, 0) = -turn_per_way;
  G(kYaw, 1) = turn_per_way;
  return G;
}

filters::Step<WheelHeading> driven(const WheelHeading& x, const ins::WheelWay& way, double dt,
                                   const ins::OdometerConfig& odometer, const HeadingFilterConfig& config,
                                   double level_walk) {
  const Arc arc = arcOf(x, way, odometer.track);
  filters::Step<WheelHeading> step{x, Matrix<8, 8>::Identity(), Matrix<8, 8>::Zero()};
  step.next.p_map += arc.moved;
  step.next.yaw = wrapAngle(x.yaw + arc.turn);
  step.F.block<3, 1>(kAxle, kClimb) = arc.by_climb;
  step.F.block<3, 1>(kAxle, kYaw) = arc.by_yaw;
  step.F.block<3, 1>(kAxle, kTrackError) = -way.turn(odometer.track) * arc.by_turn;
  step.F(kYaw, kTrackError) = -way.turn(odometer.track);
  const Matrix<8, 2> G = wayGain(x, way, odometer.track);
  const Vector<2> q(ins::wayVariance(odometer, way.left), ins::wayVariance(odometer, way.right));
  step.Qd = G * q.asDiagonal() * G.transpose();
  step.Qd(kClimb, kClimb) += square(level_walk) * dt;
  step.Qd(kRoll, kRoll) += square(level_walk) * dt;
  step.Qd(kYawBias, kYawBias) += square(config.yaw_bias.walk_per_sqrt_s) * dt;
  step.Qd(kTrackError, kTrackError) += square(config.track_error.walk_per_sqrt_s) * dt;
  return step;
}

SeenAttitude seenAttitude(const Eigen::Matrix3d& R) {
  return {std::asin(std::clamp(R(2, 0), -1.0, 1.0)), std::atan2(R(2, 1), R(2, 2)),
          std::atan2(R(1, 0), R(0, 0))};
}

filters::Innovation<WheelHeading, 3> attitudeSeen(const WheelHeading& x, const SeenAttitude& seen) {
  filters::Innovation<WheelHeading, 3> innovation{
      {seen.climb - x.climb, wrapAngle(seen.roll - x.roll), wrapAngle(seen.yaw - x.yaw - x.yaw_bias)},
      Matrix<3, 8>::Zero()};
  innovation.H.block<3, 3>(0, kClimb).setIdentity();
  innovation.H(2, kYawBias) = 1.0;
  return innovation;
}

Matrix<6, 6> poseCovariance(const Belief<WheelHeading>& belief) {
  const WheelHeading& x = belief.mean;
  Matrix<6, 8> J = Matrix<6, 8>::Zero();
  J.block<3, 3>(0, kAxle).setIdentity();
  // Rates of climb, roll and yaw seen in the body's axes; pitch is minus climb.
  const double s = std::sin(x.roll);
  const double c = std::cos(x.roll);
  J.block<3, 1>(3, kClimb) << 0.0, -c, s;
  J.block<3, 1>(3, kRoll) << 1.0, 0.0, 0.0;
  J.block<3, 1>(3, kYaw) << std::sin(x.climb), s * std::cos(x.climb), c * std::cos(x.climb);
  return J * belief.covariance * J.transpose();
}

}  // namespace pos::estimation
