#include "pos/estimation/sins_state.hpp"

#include <cmath>

#include "pos/core/square.hpp"
#include "pos/core/wide.hpp"
#include "pos/ins/block_transition.hpp"

namespace pos::estimation {
namespace {

using ins::kAccelerometerBias;
using ins::kGyroBias;
using ins::kInertial;
using ins::kPhi;
using ins::kPosition;
using ins::kVelocity;
using ins::skew;

template <int M>
filters::Innovation<SinsDrState, M> empty() {
  filters::Innovation<SinsDrState, M> innovation;
  innovation.nu.setZero();
  innovation.H.setZero();
  return innovation;
}

/// What a while adds to the covariance: a diagonal, and a block for the wheels' position.
struct SinsDrNoise {
  Vector<21> diagonal = Vector<21>::Zero();
  Matrix<3, 3> wheels = Matrix<3, 3>::Zero();
};

/// Each wheel's way has k_d^2 |way|; their mean half of it, along the way.
Matrix<3, 3> wayNoise(const SinsDrConfig& config, const SinsDrState& x, double way) {
  const Eigen::Vector3d along = x.nav.q_n_b * x.rollingDirection();
  const Matrix<3, 3> q = along * along.transpose();  // scaled afterwards: symmetric to the last bit
  return 0.5 * square(config.odometer.noise_per_sqrt_m) * std::abs(way) * q;
}

/// How the wheels' position follows attitude, scale and mounting over a way.
void addWheels(ins::BlockTransition<21>& Phi, const SinsDrConfig& config, const SinsDrState& x,
               const Eigen::Matrix3d& C, const Eigen::Vector3d& moved_n, double way) {
  Phi.add(kWheelPosition, kPhi, Eigen::Matrix3d(-skew(moved_n)));
  if (!x.earth.isFlat())
    Phi.add(kWheelPosition, kWheelPosition, ins::metricRate(x.earth.at(x.wheel_coordinates), moved_n));
  Phi.add(kWheelPosition, kScale, Eigen::Vector3d(-way * (C * x.rollingDirection())));
  if (config.boresight_sigma > 0.0) {
    Phi.add(kWheelPosition, kBoresightPitch, Eigen::Vector3d(way * C.col(2)));
    Phi.add(kWheelPosition, kBoresightYaw, Eigen::Vector3d(way * C.col(1)));
  }
}

SinsDrNoise noiseOver(const SinsDrConfig& config, const SinsDrState& x, const SinsDrInput& input, double dt) {
  SinsDrNoise q;
  q.diagonal.segment<3>(kPhi).setConstant(square(config.imu.gyro_density) * dt);
  q.diagonal.segment<3>(kVelocity).setConstant(square(config.imu.accelerometer_density) * dt);
  q.diagonal.segment<3>(kGyroBias).setConstant(square(config.imu.gyro_bias_walk) * dt);
  q.diagonal.segment<3>(kAccelerometerBias).setConstant(square(config.imu.accelerometer_bias_walk) * dt);
  q.diagonal[kScale] = square(config.odometer_scale_walk) * dt;
  q.wheels = wayNoise(config, x, input.wheel_speed * dt);  // the rest is white in velocity
  q.wheels.diagonal().array() += square(config.odometer_velocity_sigma) * input.wheel_interval * dt;
  return q;
}

void addNoise(Matrix<21, 21>& P, const SinsDrNoise& noise) {
  P.diagonal() += noise.diagonal;
  P.block<3, 3>(kWheelPosition, kWheelPosition) += noise.wheels;
}

/// P <- P - W W' for 21 x 21 and 21 x 3, column after column; one half, then the other.
POS_WIDE void takeOff(double* __restrict__ P, const double* __restrict__ W) {
  constexpr int n = 21;
  for (int j = 0; j < n; ++j) {
    const double a = W[j];
    const double b = W[n + j];
    const double c = W[2 * n + j];
    for (int i = j; i < n; ++i) P[n * j + i] -= W[i] * a + W[n + i] * b + W[2 * n + i] * c;
  }
  for (int j = 1; j < n; ++j) {
    for (int i = 0; i < j; ++i) P[n * j + i] = P[n * i + j];
  }
}

}  // namespace

Eigen::Vector3d SinsDrState::rollingDirection() const {
  return {std::cos(boresight_yaw) * std::cos(boresight_pitch),
          std::sin(boresight_yaw) * std::cos(boresight_pitch), std::sin(boresight_pitch)};
}

SinsDrState plus(const SinsDrState& x, const Tangent<SinsDrState>& d) {
  SinsDrState next = x;
  const Eigen::Vector3d metric = x.earth.at(x.nav.coordinates).metric;
  next.nav.q_n_b = (quaternionFromRotationVector(d.segment<3>(kPhi)) * x.nav.q_n_b).normalized();
  next.nav.v_n += d.segment<3>(kVelocity);
  next.nav.coordinates += d.segment<3>(kPosition).cwiseQuotient(metric);
  next.gyro_bias += d.segment<3>(kGyroBias);
  next.accelerometer_bias += d.segment<3>(kAccelerometerBias);
  next.wheel_coordinates += d.segment<3>(kWheelPosition).cwiseQuotient(metric);
  next.scale += d[kScale];
  next.boresight_pitch += d[kBoresightPitch];
  next.boresight_yaw += d[kBoresightYaw];
  return next;
}

Tangent<SinsDrState> minus(const SinsDrState& to, const SinsDrState& from) {
  const Eigen::Vector3d metric = from.earth.at(from.nav.coordinates).metric;
  Tangent<SinsDrState> d;
  d.segment<3>(kPhi) = rotationVector(to.nav.q_n_b * from.nav.q_n_b.conjugate());
  d.segment<3>(kVelocity) = to.nav.v_n - from.nav.v_n;
  d.segment<3>(kPosition) = (to.nav.coordinates - from.nav.coordinates).cwiseProduct(metric);
  d.segment<3>(kGyroBias) = to.gyro_bias - from.gyro_bias;
  d.segment<3>(kAccelerometerBias) = to.accelerometer_bias - from.accelerometer_bias;
  d.segment<3>(kWheelPosition) = (to.wheel_coordinates - from.wheel_coordinates).cwiseProduct(metric);
  d[kScale] = to.scale - from.scale;
  d[kBoresightPitch] = to.boresight_pitch - from.boresight_pitch;
  d[kBoresightYaw] = to.boresight_yaw - from.boresight_yaw;
  return d;
}

Matrix<21, 21> sinsDrErrorF(const SinsDrState& x, const SinsDrInput& input) {
  Matrix<21, 21> F = Matrix<21, 21>::Zero();
  const ins::ErrorModel model = ins::errorModel(x.earth, x.nav, input.force_b);
  F.topLeftCorner<kInertial, kInertial>() = ins::denseF(model);
  const Eigen::Vector3d rolling = input.wheel_speed * (model.C * x.rollingDirection());
  F.block<3, 3>(kWheelPosition, kPhi) = skew(input.wheel_v_n);
  F.block<3, 3>(kWheelPosition, kWheelPosition) =
      ins::metricRate(x.earth.at(x.wheel_coordinates), input.wheel_v_n);
  F.block<3, 1>(kWheelPosition, kScale) = rolling;
  F.block<3, 1>(kWheelPosition, kBoresightPitch) = input.wheel_speed * model.C.col(2);
  F.block<3, 1>(kWheelPosition, kBoresightYaw) = input.wheel_speed * model.C.col(1);
  return F;
}

Vector<21> errorSigns() {
  Vector<21> signs = Vector<21>::Ones();
  signs.segment<3>(kVelocity).setConstant(-1.0);
  signs.segment<3>(kPosition).setConstant(-1.0);
  signs.segment<3>(kWheelPosition).setConstant(-1.0);
  signs[kBoresightPitch] = signs[kBoresightYaw] = -1.0;
  return signs;
}

Matrix<21, 21> sinsDrNoise(const SinsDrConfig& config, const SinsDrState& x, const SinsDrInput& input) {
  Matrix<21, 21> q = Matrix<21, 21>::Zero();
  addNoise(q, noiseOver(config, x, input, 1.0));
  return q;
}

filters::Step<SinsDrState> sinsDrStep(const SinsDrConfig& config, const SinsDrState& x,
                                      const SinsDrInput& input, double dt) {
  const Matrix<21, 21> FT = dt * sinsDrErrorF(x, input);
  const Matrix<21, 21> Phi = Matrix<21, 21>::Identity() + FT + 0.5 * FT * FT;
  const Matrix<21, 21> q = sinsDrNoise(config, x, input);
  const Vector<21> s = errorSigns();
  filters::Step<SinsDrState> step{x, s.asDiagonal() * Phi * s.asDiagonal(), {}};
  const Matrix<21, 21> Qd = 0.5 * dt * (Phi * q * Phi.transpose() + q);
  step.Qd = s.asDiagonal() * Qd * s.asDiagonal();
  return step;
}

void propagate(Belief<SinsDrState>& belief, const SinsDrConfig& config, const SinsDrInput& input, double dt) {
  const SinsDrState& x = belief.mean;
  const ins::ErrorModel model = ins::errorModel(x.earth, x.nav, input.force_b);
  ins::BlockTransition<21> Phi;
  ins::addInertial(Phi, x.earth, model, dt);
  const Eigen::Vector3d moved_n = dt * input.wheel_v_n;
  addWheels(Phi, config, x, model.C, moved_n, dt * input.wheel_speed);
  Phi.add(kWheelPosition, kGyroBias, Eigen::Matrix3d(0.5 * dt * skew(moved_n) * model.C));
  const SinsDrNoise half = noiseOver(config, x, input, 0.5 * dt);
  addNoise(belief.covariance, half);
  Phi.carry(belief.covariance);
  addNoise(belief.covariance, half);
}

void propagateWheels(Belief<SinsDrState>& belief, const SinsDrConfig& config, const Eigen::Vector3d& moved_n,
                     double way) {
  const SinsDrState& x = belief.mean;
  ins::BlockTransition<21> Phi;
  addWheels(Phi, config, x, x.nav.C_n_b(), moved_n, way);
  const Matrix<3, 3> half = wayNoise(config, x, 0.5 * way);
  belief.covariance.block<3, 3>(kWheelPosition, kWheelPosition) += half;
  Phi.carry(belief.covariance);
  belief.covariance.block<3, 3>(kWheelPosition, kWheelPosition) += half;
}

SinsDrState rolled(SinsDrState x, const Eigen::Quaterniond& q_before, const Eigen::Quaterniond& q_now,
                   double way, const InertialMounts& mounts) {
  const Eigen::Vector3d arm = mounts.imu - mounts.axle;
  const Eigen::Quaterniond half = q_before.slerp(0.5, q_now);
  // The chord of the arc is shorter than the way by sinc of half the turn.
  const double chord = way * ins::sinc(0.5 * q_before.angularDistance(q_now));
  const Eigen::Vector3d moved = half * (chord * x.rollingDirection()) + (q_now * arm - q_before * arm);
  x.wheel_coordinates += moved.cwiseQuotient(x.earth.at(x.wheel_coordinates).metric);
  return x;
}

filters::Innovation<SinsDrState, 3> positionDifference(const SinsDrState& x, double age) {
  auto innovation = empty<3>();
  innovation.nu = -(ins::metresBetween(x.earth, x.wheel_coordinates, x.nav.coordinates) + age * x.nav.v_n);
  innovation.H.block<3, 3>(0, kPosition).setIdentity();
  innovation.H.block<3, 3>(0, kVelocity) = age * Eigen::Matrix3d::Identity();
  innovation.H.block<3, 3>(0, kWheelPosition) = -Eigen::Matrix3d::Identity();
  return innovation;
}

filters::Correction<3> correctDifference(Belief<SinsDrState>& belief, double age, const Matrix<3, 3>& R) {
  Matrix<21, 21>& P = belief.covariance;
  const auto seen = [&](const auto& columns) {
    return (columns.template middleCols<3>(kPosition) + age * columns.template middleCols<3>(kVelocity) -
            columns.template middleCols<3>(kWheelPosition))
        .eval();
  };
  const Matrix<21, 3> G = seen(P);  // P H'
  filters::Correction<3> result;
  result.nu = positionDifference(belief.mean, age).nu;
  result.S = seen(Matrix<3, 21>(G.transpose())).transpose() + R;
  const Eigen::LLT<Matrix<3, 3>> S_factor(result.S);
  if (S_factor.info() != Eigen::Success || !result.S.allFinite() || !result.nu.allFinite()) {
    result.verdict = Verdict::Degenerate;
    return result;
  }
  const Vector<3> whitened = S_factor.matrixL().solve(result.nu);
  result.nis = whitened.squaredNorm();
  // W = G L'^-1, column by column.
  const Matrix<3, 3>& L = S_factor.matrixLLT();
  Matrix<21, 3> W;
  W.col(0) = G.col(0) / L(0, 0);
  W.col(1) = (G.col(1) - L(1, 0) * W.col(0)) / L(1, 1);
  W.col(2) = (G.col(2) - L(2, 0) * W.col(0) - L(2, 1) * W.col(1)) / L(2, 2);
  belief.mean = plus(belief.mean, Tangent<SinsDrState>(W * whitened));
  takeOff(P.data(), W.data());
  return result;
}

filters::Innovation<SinsDrState, 3> velocityDifference(const SinsDrState& x, const SinsDrInput& input) {
  auto innovation = empty<3>();
  innovation.nu = -(x.nav.v_n - input.wheel_v_n);
  innovation.H.block<3, 3>(0, kVelocity).setIdentity();
  innovation.H.block<3, 3>(0, kPhi) = skew(input.wheel_v_n);
  innovation.H.block<3, 1>(0, kScale) = input.wheel_speed * (x.nav.q_n_b * x.rollingDirection());
  return innovation;
}

filters::Innovation<SinsDrState, 3> zeroVelocity(const SinsDrState& x) {
  auto innovation = empty<3>();
  innovation.nu = -x.nav.v_n;
  innovation.H.block<3, 3>(0, kVelocity).setIdentity();
  return innovation;
}

filters::Innovation<SinsDrState, 3> zeroRate(const SinsDrState& x, const Eigen::Vector3d& mean_rate) {
  auto innovation = empty<3>();
  const Eigen::Matrix3d C_b_n = x.nav.C_n_b().transpose();
  const Eigen::Vector3d omega_ie = x.earth.at(x.nav.coordinates).omega_ie;
  innovation.nu = mean_rate - (C_b_n * omega_ie + x.gyro_bias);
  innovation.H.block<3, 3>(0, kPhi) = C_b_n * skew(omega_ie);
  innovation.H.block<3, 3>(0, kGyroBias).setIdentity();
  return innovation;
}

filters::Innovation<SinsDrState, 2> noSidewaysSpeed(const SinsDrState& x, const Eigen::Vector3d& rate,
                                                    const InertialMounts& mounts) {
  auto innovation = empty<2>();
  const Eigen::Matrix3d C_b_n = x.nav.C_n_b().transpose();
  const Eigen::Vector3d at_axle = C_b_n * x.nav.v_n + rate.cross(mounts.axle - mounts.imu);
  innovation.nu = -at_axle.tail<2>();
  innovation.H.block<2, 3>(0, kVelocity) = C_b_n.bottomRows<2>();
  innovation.H.block<2, 3>(0, kPhi) = (C_b_n * skew(x.nav.v_n)).bottomRows<2>();
  return innovation;
}

filters::Innovation<SinsDrState, 3> positionFix(const SinsDrState& x, const Eigen::Vector3d& offset_n,
                                                const Eigen::Vector3d& lever) {
  auto innovation = empty<3>();
  innovation.nu = offset_n;
  innovation.H.block<3, 3>(0, kPosition).setIdentity();
  innovation.H.block<3, 3>(0, kPhi) = -skew(x.nav.q_n_b * lever);  // point = p + C lever
  return innovation;
}

filters::Innovation<SinsDrState, 1> headingFix(const SinsDrState& x, double difference) {
  auto innovation = empty<1>();
  const Eigen::Vector3d f = x.nav.q_n_b * Eigen::Vector3d::UnitX();
  const double level = f.head<2>().squaredNorm();
  innovation.nu[0] = difference;
  innovation.H.block<1, 3>(0, kPhi) << -f.x() * f.z() / level, -f.y() * f.z() / level, 1.0;
  return innovation;
}

void reanchor(Belief<SinsDrState>& belief) {
  belief.mean.wheel_coordinates = belief.mean.nav.coordinates;
  Matrix<21, 21>& P = belief.covariance;
  P.middleRows<3>(kWheelPosition) = P.middleRows<3>(kPosition).eval();
  P.middleCols<3>(kWheelPosition) = P.middleCols<3>(kPosition).eval();
  filters::symmetrise(P);
}

}  // namespace pos::estimation
