#include "pos/estimation/shearer_state.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "pos/core/pose3.hpp"
#include "pos/core/square.hpp"
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

using InertialMatrix = Eigen::Matrix<double, kInertial, kInertial>;
using Wide = Eigen::Matrix<double, kInertial, Eigen::Dynamic, 0, kInertial, kShearerRows>;
using Gain = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kShearerRows, 3>;

/// Force and what else the state's own motion says over dt, so that a common turn of everything stays
/// unseen: the velocity that the force gave is the change of velocity less gravity's.
ins::ErrorModel modelBetween(const ShearerState& x, const ins::NavigationState& before, double dt) {
  const ins::EarthPoint here = x.earth.at(x.nav.coordinates);
  const Eigen::Vector3d gravity(0.0, 0.0, -here.gravity);
  const Eigen::Vector3d coriolis = 2.0 * here.omega_ie.cross(0.5 * (x.nav.v_n + before.v_n));
  ins::ErrorModel m;
  m.C = 0.5 * (before.C_n_b() + x.nav.C_n_b());
  m.phi_phi = -skew(here.omega_ie);
  m.v_phi = skew((x.nav.v_n - before.v_n) / dt - gravity + coriolis);
  m.v_v = -skew(2.0 * here.omega_ie);
  return m;
}

/// The least a row or column of P has to lose: one half, then the other.
void takeOff(ShearerMatrix& P, const Gain& W) {
  const Eigen::Index n = P.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    const double a = W(j, 0);
    const double b = W(j, 1);
    const double c = W(j, 2);
    double* p = P.data() + j * n;
    const double* w = W.data();
    for (Eigen::Index i = j; i < n; ++i) p[i] -= w[i] * a + w[n + i] * b + w[2 * n + i] * c;
  }
  for (Eigen::Index j = 1; j < n; ++j) {
    for (Eigen::Index i = 0; i < j; ++i) P(i, j) = P(j, i);
  }
}

/// Rows `row` of the tangent referred to an attitude corrected anew: d <- d - [moved x] phi.
void referAnew(ShearerBelief& belief, int row, const Eigen::Vector3d& moved) {
  const Eigen::Matrix3d S = skew(moved);
  ShearerMatrix& P = belief.covariance;
  // First rows, then columns: the block on the diagonal gets both.
  P.middleRows<3>(row) -= S.lazyProduct(P.middleRows<3>(kPhi)).eval();
  P.middleCols<3>(row) -= P.middleCols<3>(kPhi).lazyProduct(S.transpose()).eval();
}

}  // namespace

std::optional<int> ShearerState::indexOf(int id) const {
  for (int i = 0; i < landmark_count; ++i) {
    if (landmarks[static_cast<std::size_t>(i)].id == id) return i;
  }
  return std::nullopt;
}

void inject(ShearerState& x, const ShearerVector& d) {
  x.nav.q_n_b = (quaternionFromRotationVector(d.segment<3>(kPhi)) * x.nav.q_n_b).normalized();
  x.nav.v_n += d.segment<3>(kVelocity);
  x.nav.coordinates += d.segment<3>(kPosition);
  x.gyro_bias += d.segment<3>(kGyroBias);
  x.accelerometer_bias += d.segment<3>(kAccelerometerBias);
  if (x.sensor_states) x.sensor = plus(x.sensor, d.segment<LegSensor::kDof>(x.sensorRow()));
  for (int i = 0; i < x.landmark_count; ++i)
    x.landmarks[static_cast<std::size_t>(i)].p_n += d.segment<3>(x.rowOf(i));
}

void propagate(ShearerBelief& belief, const ins::NavigationState& before, const ImuNoise& noise, double dt) {
  if (dt <= 0.0) return;
  ins::BlockTransition<kInertial> Phi;
  ins::addInertial(Phi, belief.mean.earth, modelBetween(belief.mean, before, dt), dt);
  ShearerMatrix& P = belief.covariance;
  Eigen::Matrix<double, kInertial, 1> half;  // of the noise: half before the transition, half after
  half.segment<3>(kPhi).setConstant(0.5 * dt * square(noise.gyro_density));
  half.segment<3>(kVelocity).setConstant(0.5 * dt * square(noise.accelerometer_density));
  half.segment<3>(kPosition).setZero();
  half.segment<3>(kGyroBias).setConstant(0.5 * dt * square(noise.gyro_bias_walk));
  half.segment<3>(kAccelerometerBias).setConstant(0.5 * dt * square(noise.accelerometer_bias_walk));
  InertialMatrix own = P.topLeftCorner<kInertial, kInertial>();
  own.diagonal() += half;
  Phi.carry(own);
  own.diagonal() += half;
  P.topLeftCorner<kInertial, kInertial>() = own;
  const Eigen::Index rest = P.rows() - kInertial;
  const InertialMatrix dense = rest > 0 || belief.by_yaw.size() > 0 ? Phi.dense() : InertialMatrix();
  if (rest > 0) {
    const Wide cross = dense.lazyProduct(P.topRightCorner(kInertial, rest));
    P.topRightCorner(kInertial, rest) = cross;
    P.bottomLeftCorner(rest, kInertial) = cross.transpose();
  }
  if (belief.by_yaw.size() > 0)
    belief.by_yaw.head<kInertial>() = (dense * belief.by_yaw.head<kInertial>()).eval();
}

Eigen::Vector3d placeOf(const ShearerState& x, const LegSight& sight, const Eigen::Vector3d& arm) {
  return x.nav.coordinates + sight.age * x.nav.v_n +
         x.nav.q_n_b * (arm + corrected(sight.measured, x.sensor).p);
}

Eigen::Vector3d inScanner(const ShearerState& x, const Eigen::Vector3d& p_n, const Eigen::Vector3d& arm) {
  return x.nav.q_n_b.conjugate() * (p_n - x.nav.coordinates) - arm;
}

Eigen::Vector3d expectedLeg(const ShearerState& x, int index, const Eigen::Vector3d& arm) {
  return inScanner(x, x.landmarks[static_cast<std::size_t>(index)].p_n, arm);
}

ShearerInnovation legInnovation(const ShearerState& x, const LegSight& sight, int index,
                                const Eigen::Vector3d& arm) {
  const Eigen::Matrix3d C = x.nav.C_n_b();
  const CorrectedLeg leg = corrected(sight.measured, x.sensor);
  const Eigen::Vector3d position = x.nav.coordinates + sight.age * x.nav.v_n;
  const Eigen::Vector3d r = x.landmarks[static_cast<std::size_t>(index)].p_n - position;
  ShearerInnovation out;
  out.nu = C * (leg.p + arm) - r;
  out.H.setZero(3, x.dof());
  out.H.middleCols<3>(kPhi) = skew(r);
  out.H.middleCols<3>(kVelocity) = -sight.age * Eigen::Matrix3d::Identity();
  out.H.middleCols<3>(kPosition) = -Eigen::Matrix3d::Identity();
  out.H.middleCols<3>(x.rowOf(index)).setIdentity();
  const Eigen::Matrix<double, 3, LegSensor::kDof> by_errors = C * leg.by_errors;
  if (x.sensor_states) out.H.middleCols<LegSensor::kDof>(x.sensorRow()) = -by_errors;
  out.by_yaw = by_errors.col(0);
  return out;
}

ShearerInnovation stopInnovation(const ShearerState& x, int index, const Eigen::Vector3d& offset) {
  ShearerInnovation out;
  out.nu = x.landmarks[static_cast<std::size_t>(index)].p_n + offset - x.nav.coordinates;
  out.H.setZero(3, x.dof());
  out.H.middleCols<3>(kPosition).setIdentity();
  out.H.middleCols<3>(x.rowOf(index)) = -Eigen::Matrix3d::Identity();
  return out;
}

ShearerInnovation placeInnovation(const ShearerState& x, const Eigen::Vector3d& p_n) {
  ShearerInnovation out;
  out.nu = p_n - x.nav.coordinates;
  out.H.setZero(3, x.dof());
  out.H.middleCols<3>(kPosition).setIdentity();
  return out;
}

ShearerCorrection correct(ShearerBelief& belief, const ShearerInnovation& innovation,
                          const Eigen::Matrix3d& R, double gate) {
  ShearerMatrix& P = belief.covariance;
  const Gain G = P.lazyProduct(innovation.H.transpose());
  const Eigen::Matrix3d S = innovation.H.lazyProduct(G) + R;
  const Eigen::LLT<Eigen::Matrix3d> factor(S);
  if (factor.info() != Eigen::Success || !S.allFinite() || !innovation.nu.allFinite())
    return {.verdict = Verdict::Degenerate};
  const Eigen::Vector3d white = factor.matrixL().solve(innovation.nu);
  ShearerCorrection result{.nis = white.squaredNorm()};
  if (result.nis > gate) {
    result.verdict = Verdict::Gated;
    return result;
  }
  const Eigen::Matrix3d L = factor.matrixL();
  const Eigen::Matrix3d inverse_L = L.triangularView<Eigen::Lower>().solve(Eigen::Matrix3d::Identity());
  const Gain W = G.lazyProduct(inverse_L.transpose());  // P H' L'^-1: K = W L^-1
  const ShearerVector d = W * white;
  takeOff(P, W);
  if (belief.by_yaw.size() > 0) {
    // nu moves by its own dependence and by that of the tangent; the tangent, truth less state, by - K nu.
    const Eigen::Vector3d by_yaw = innovation.by_yaw + innovation.H * belief.by_yaw;
    belief.by_yaw -= W * (inverse_L * by_yaw);
  }
  ShearerState& x = belief.mean;
  inject(x, d);
  for (const int row : {int{kVelocity}, int{kPosition}}) referAnew(belief, row, d.segment<3>(row));
  for (int i = 0; i < x.landmark_count; ++i) referAnew(belief, x.rowOf(i), d.segment<3>(x.rowOf(i)));
  return result;
}

namespace {

/// Room for three more rows: J P, J P J' + R.
void augment(ShearerBelief& belief, const ShearerRows3& J, const Eigen::Matrix3d& R, Initialisation how) {
  ShearerMatrix& P = belief.covariance;
  const Eigen::Index n = P.rows();
  const ShearerRows3 cross = J * P;
  Eigen::Matrix3d own = cross * J.transpose() + R;
  own = (0.5 * (own + own.transpose())).eval();
  P.conservativeResize(n + 3, n + 3);
  if (how == Initialisation::Correlated) {
    P.bottomLeftCorner(3, n) = cross;
    P.topRightCorner(n, 3) = cross.transpose();
  } else {
    P.bottomLeftCorner(3, n).setZero();
    P.topRightCorner(n, 3).setZero();
  }
  P.bottomRightCorner<3, 3>() = own;
}

bool roomFor(const ShearerState& x) {
  return x.landmark_count < kMaxLegs;
}

void append(ShearerState& x, int id, const Eigen::Vector3d& p_n) {
  x.landmarks[static_cast<std::size_t>(x.landmark_count++)] = {.id = id, .p_n = p_n};
}

}  // namespace

bool addLandmark(ShearerBelief& belief, int id, const LegSight& sight, const Eigen::Vector3d& arm,
                 Initialisation how) {
  ShearerState& x = belief.mean;
  if (!roomFor(x)) return false;
  const Eigen::Matrix3d C = x.nav.C_n_b();
  const CorrectedLeg leg = corrected(sight.measured, x.sensor);
  const Eigen::Vector3d r = C * (arm + leg.p);
  ShearerRows3 J;
  J.setZero(3, x.dof());
  J.middleCols<3>(kPhi) = -skew(r);
  J.middleCols<3>(kVelocity) = sight.age * Eigen::Matrix3d::Identity();
  J.middleCols<3>(kPosition).setIdentity();
  const Eigen::Matrix<double, 3, LegSensor::kDof> by_errors = C * leg.by_errors;
  if (x.sensor_states) J.middleCols<LegSensor::kDof>(x.sensorRow()) = by_errors;
  augment(belief, J, C * sight.covariance * C.transpose(), how);
  if (belief.by_yaw.size() > 0) {
    // Truth less state: the state's landmark moves with the mount, so the tangent moves the other way.
    const Eigen::Vector3d by_yaw = J * belief.by_yaw - by_errors.col(0);
    belief.by_yaw.conservativeResize(belief.by_yaw.size() + 3);
    belief.by_yaw.tail<3>() = by_yaw;
  }
  append(x, id, x.nav.coordinates + sight.age * x.nav.v_n + r);
  return true;
}

bool addStop(ShearerBelief& belief, int id) {
  ShearerState& x = belief.mean;
  if (!roomFor(x)) return false;
  ShearerRows3 J;
  J.setZero(3, x.dof());
  J.middleCols<3>(kPosition).setIdentity();
  augment(belief, J, Eigen::Matrix3d::Zero(), Initialisation::Correlated);
  if (belief.by_yaw.size() > 0) {
    const Eigen::Vector3d by_yaw = belief.by_yaw.segment<3>(kPosition);
    belief.by_yaw.conservativeResize(belief.by_yaw.size() + 3);
    belief.by_yaw.tail<3>() = by_yaw;
  }
  append(x, id, x.nav.coordinates);
  return true;
}

void removeLandmark(ShearerBelief& belief, int index) {
  ShearerState& x = belief.mean;
  ShearerMatrix& P = belief.covariance;
  const int row = x.rowOf(index);
  const int after = x.dof() - row - 3;
  // Towards the front: each block is read before it is written.
  for (int i = 0; i < after; ++i) P.col(row + i) = P.col(row + 3 + i).eval();
  for (int i = 0; i < after; ++i) P.row(row + i) = P.row(row + 3 + i).eval();
  P.conservativeResize(P.rows() - 3, P.cols() - 3);
  if (belief.by_yaw.size() > 0) {
    for (int i = 0; i < after; ++i) belief.by_yaw[row + i] = belief.by_yaw[row + 3 + i];
    belief.by_yaw.conservativeResize(belief.by_yaw.size() - 3);
  }
  for (int i = index; i + 1 < x.landmark_count; ++i)
    x.landmarks[static_cast<std::size_t>(i)] = x.landmarks[static_cast<std::size_t>(i) + 1];
  --x.landmark_count;
}

}  // namespace pos::estimation
