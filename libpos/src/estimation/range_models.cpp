#include "pos/estimation/range_models.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/square.hpp"

namespace pos::estimation {
namespace {

using State = RangeState;
using Term = StateTerm;

/// d (R(yaw) v) / d yaw = R(90 deg) R(yaw) v, from R(yaw) v.
Eigen::Vector2d derivativeOfTurned(const Eigen::Vector2d& Rv) {
  return {-Rv.y(), Rv.x()};
}

filters::Step<State> standingStill(const State& x) {
  const auto n = x.values.size();
  return {x, TangentMatrix<State>::Identity(n, n), TangentMatrix<State>::Zero(n, n)};
}

/// Random walks of the calibration states, variance growing with time.
void addCalibrationWalk(TangentMatrix<State>& Qd, const RangeLayout& layout,
                        const RangeOdometryConfig& config, double dt) {
  const auto add = [&](Term term, const CalibrationState& c) {
    if (const auto row = layout.row(term)) Qd(*row, *row) += square(c.walk_per_sqrt_s) * dt;
  };
  add(Term::GyroBias, config.gyro_bias);
  add(Term::WheelScale, config.wheel_scale);
  add(Term::RangeScale, config.range_scale);
  add(Term::RangeOffset, config.range_offset);
  add(Term::Latency, config.latency);
  const auto anchors = static_cast<Eigen::Index>(layout.anchors().size());
  Qd.diagonal().tail(anchors).array() += square(config.anchor_offset.walk_per_sqrt_s) * dt;
}

/// Where the body is `age` seconds after the state, and how that depends on the state.
struct Carried {
  Eigen::Vector2d position;
  double yaw;
  Eigen::Vector2d velocity_map;
  double yaw_rate;
  Eigen::Vector2d dposition_dyaw;  ///< through the body-axes velocity; zero where velocity is a state
};

Carried carried(const State& x, const RangeLayout& layout, const BodyVelocity& odometry, double age) {
  if (layout.row(Term::VelocityX)) {
    const Eigen::Vector2d v = x.velocity(layout);
    const double yaw_rate = x.value(layout, Term::YawRate);
    return {x.position() + age * v, x.pose().yaw + age * yaw_rate, v, yaw_rate, Eigen::Vector2d::Zero()};
  }
  const double yaw = x.pose().yaw;
  const Eigen::Vector2d v = rotation2(yaw) * odometry.linear;
  return {x.position() + age * v, yaw + age * odometry.yaw_rate, v, odometry.yaw_rate,
          age * derivativeOfTurned(v)};
}

}  // namespace

Matrix<3, 3> odometryCovariance(const OdometryNoise& noise, const Pose2& increment, double dt) {
  const double distance = increment.translation().norm();
  const double still = square(noise.position_per_sqrt_s) * dt;
  return Vector<3>(square(noise.distance_per_sqrt_m) * distance + still,
                   square(noise.lateral_per_sqrt_m) * distance + still,
                   square(noise.yaw_per_sqrt_m) * distance +
                       square(noise.yaw_per_sqrt_rad) * std::abs(increment.yaw) +
                       square(noise.yaw_per_sqrt_s) * dt)
      .asDiagonal();
}

filters::Step<State> OdometryMotion::step(const State& x, const Pose2& increment, double dt) const {
  filters::Step<State> step = standingStill(x);
  const double bias = x.value(*layout, Term::GyroBias);
  const double scale = x.value(*layout, Term::WheelScale);
  // The bias turned the body by bias*dt too far over the increment, by half of that on average while it
  // moved.
  const double direction = x.pose().yaw - 0.5 * bias * dt;
  const Eigen::Matrix2d R = rotation2(direction);
  const Eigen::Vector2d unscaled_map = R * increment.translation();
  const Eigen::Vector2d moved_map = scale * unscaled_map;
  const Eigen::Vector2d dmoved_dyaw = derivativeOfTurned(moved_map);
  step.next.values.head<2>() += moved_map;
  step.next.values[2] = wrapAngle(x.pose().yaw + increment.yaw - bias * dt);

  step.F.block<2, 1>(0, 2) = dmoved_dyaw;
  if (const auto row = layout->row(Term::GyroBias)) {
    step.F.block<2, 1>(0, *row) = -0.5 * dt * dmoved_dyaw;
    step.F(2, *row) = -dt;
  }
  if (const auto row = layout->row(Term::WheelScale)) {
    step.F.block<2, 1>(0, *row) = unscaled_map;
  }
  Matrix<3, 3> R_pose = Matrix<3, 3>::Identity();
  R_pose.topLeftCorner<2, 2>() = R;
  step.Qd.topLeftCorner<3, 3>() =
      R_pose * odometryCovariance(config->odometry_noise, increment, dt) * R_pose.transpose();
  addCalibrationWalk(step.Qd, *layout, *config, dt);
  return step;
}

filters::Step<State> ConstantVelocityMotion::step(const State& x, NoInput, double dt) const {
  filters::Step<State> step = standingStill(x);
  // White acceleration of density q: covariance of [integral, derivative] over dt is q^2 [dt^3/3 dt^2/2;
  // dt^2/2 dt].
  const auto integrate = [&](int position, int rate, double density) {
    const double q = square(density);
    step.next.values[position] += dt * x.values[rate];
    step.F(position, rate) = dt;
    step.Qd(position, position) += q * dt * dt * dt / 3.0;
    step.Qd(position, rate) += q * dt * dt / 2.0;
    step.Qd(rate, position) += q * dt * dt / 2.0;
    step.Qd(rate, rate) += q * dt;
  };
  integrate(0, *layout->row(Term::VelocityX), config->acceleration_density);
  integrate(1, *layout->row(Term::VelocityY), config->acceleration_density);
  integrate(2, *layout->row(Term::YawRate), config->yaw_acceleration_density);
  step.next.values[2] = wrapAngle(step.next.values[2]);
  addCalibrationWalk(step.Qd, *layout, *config, dt);
  return step;
}

void predictPose(Belief<RangeState>& belief, const filters::Step<RangeState>& step) {
  constexpr int kPose = 3;
  const TangentMatrix<State>& P = belief.covariance;
  const auto n = P.rows();
  // C = P F', its three columns of the pose. F is the identity but for few elements right of the diagonal.
  Eigen::Matrix<double, Eigen::Dynamic, kPose, 0, State::kMaxDof, kPose> C = P.leftCols<kPose>();
  for (int row = 0; row < kPose; ++row) {
    for (Eigen::Index k = row + 1; k < n; ++k) {
      if (step.F(row, k) != 0.0) C.col(row) += step.F(row, k) * P.col(k);
    }
  }
  Matrix<kPose, kPose> C_pose = C.topRows<kPose>();  // F P F', its block of the pose
  for (int row = 0; row < kPose; ++row) {
    for (Eigen::Index k = row + 1; k < n; ++k) {
      if (step.F(row, k) != 0.0) C_pose.row(row) += step.F(row, k) * C.row(k);
    }
  }
  belief.mean = step.next;
  belief.covariance.leftCols<kPose>() = C;
  belief.covariance.topRows<kPose>() = C.transpose();
  auto pose = belief.covariance.topLeftCorner<kPose, kPose>();
  pose = C_pose;
  belief.covariance += step.Qd;
  filters::symmetrise(pose);
}

RangePrediction predictedRange(const State& x, const RangeLayout& layout,
                               const TangentMatrix<State>& covariance, const RangeGeometry& geometry) {
  const double age = geometry.age - x.value(layout, Term::Latency);
  const Carried body = carried(x, layout, geometry.odometry_velocity, age);
  const Eigen::Vector2d lever_map = rotation2(body.yaw) * geometry.tag_body.head<2>();
  const Eigen::Vector2d dlever_dyaw = derivativeOfTurned(lever_map);
  Eigen::Vector3d between;
  between << body.position + lever_map, geometry.body_height + geometry.tag_body.z();
  between -= geometry.anchor_map;

  RangePrediction result;
  result.distance = std::max(between.norm(), 1e-6);
  const double scale = x.value(layout, Term::RangeScale);
  const auto anchor_row = layout.anchorRow(geometry.anchor);
  result.range = scale * result.distance + x.value(layout, Term::RangeOffset) +
                 (anchor_row ? x.values[*anchor_row] : 0.0) + geometry.range_bias;

  const Eigen::Vector2d u = between.head<2>() / result.distance;  // towards the tag, horizontal part
  result.H = TangentRows<State, 1>::Zero(1, x.values.size());
  result.H.head<2>() = scale * u.transpose();
  result.H(2) = scale * u.dot(dlever_dyaw + body.dposition_dyaw);
  const auto set = [&](Term term, double derivative) {
    if (const auto row = layout.row(term)) result.H(*row) = derivative;
  };
  set(Term::VelocityX, scale * age * u.x());
  set(Term::VelocityY, scale * age * u.y());
  set(Term::YawRate, scale * age * u.dot(dlever_dyaw));
  set(Term::RangeScale, result.distance);
  set(Term::RangeOffset, 1.0);
  set(Term::Latency, -scale * u.dot(body.velocity_map + body.yaw_rate * dlever_dyaw));
  if (anchor_row) result.H(*anchor_row) = 1.0;

  const Eigen::Matrix2d hessian = scale / result.distance * (Eigen::Matrix2d::Identity() - u * u.transpose());
  const Eigen::Matrix2d spread = hessian * covariance.topLeftCorner<2, 2>();
  result.curvature_mean = 0.5 * spread.trace();
  result.curvature_variance = 0.5 * (spread * spread).trace();
  return result;
}

filters::Innovation<State, 2> positionInnovation(const State& x, const RangeLayout& layout,
                                                 const SeenPoint& seen, double age,
                                                 const BodyVelocity& odometry_velocity) {
  const Carried body = carried(x, layout, odometry_velocity, age);
  const Eigen::Vector2d lever_map = rotation2(body.yaw) * seen.p_body;
  const Eigen::Vector2d dlever_dyaw = derivativeOfTurned(lever_map);
  filters::Innovation<State, 2> innovation{seen.p_map - body.position - lever_map,
                                           TangentRows<State, 2>::Zero(2, x.values.size())};
  innovation.H.leftCols<2>().setIdentity();
  innovation.H.col(2) = body.dposition_dyaw + dlever_dyaw;
  if (const auto row = layout.row(Term::VelocityX))
    innovation.H.middleCols<2>(*row) = age * Eigen::Matrix2d::Identity();
  if (const auto row = layout.row(Term::YawRate)) innovation.H.col(*row) = age * dlever_dyaw;
  return innovation;
}

filters::Innovation<State, 3> poseInnovation(const State& x, const RangeLayout& layout, const SeenPoint& seen,
                                             double yaw, double age, const BodyVelocity& odometry_velocity) {
  const auto position = positionInnovation(x, layout, seen, age, odometry_velocity);
  const double expected = carried(x, layout, odometry_velocity, age).yaw;
  filters::Innovation<State, 3> innovation{Vector<3>::Zero(),
                                           TangentRows<State, 3>::Zero(3, x.values.size())};
  innovation.nu << position.nu, wrapAngle(yaw - expected);
  innovation.H.topRows<2>() = position.H;
  innovation.H(2, 2) = 1.0;
  if (const auto row = layout.row(Term::YawRate)) innovation.H(2, *row) = age;
  return innovation;
}

}  // namespace pos::estimation
