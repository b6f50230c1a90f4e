#include "pos/ins/error_model.hpp"

namespace pos::ins {
namespace {

/// Derivative of the transport rate by the velocity.
Eigen::Matrix3d transportByVelocity(const EarthPoint& e) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m(0, 1) = -e.inverse_meridian;
  m(1, 0) = e.inverse_transverse;
  m(2, 0) = e.inverse_transverse * e.tan_latitude;
  return m;
}

/// Derivative of the transport rate by the position in metres; the radii's own change with latitude is left
/// out (below 5e-9 of the row at 4 m/s).
Eigen::Matrix3d transportByPosition(const EarthPoint& e, const Eigen::Vector3d& v) {
  const double M = e.inverse_meridian;
  const double N = e.inverse_transverse;
  const double secant_squared = 1.0 + e.tan_latitude * e.tan_latitude;
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m(0, 2) = v.y() * M * M;
  m(1, 2) = -v.x() * N * N;
  m(2, 1) = v.x() * N * secant_squared * M;
  m(2, 2) = -v.x() * N * N * e.tan_latitude;
  return m;
}

Eigen::Matrix3d earthRateByPosition(const EarthPoint& e) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m(1, 1) = e.omega_ie_by_north_y;
  m(2, 1) = e.omega_ie_by_north_z;
  return m;
}

}  // namespace

Eigen::Matrix3d metricRate(const EarthPoint& e, const Eigen::Vector3d& v) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  m(0, 0) = v.z() * e.inverse_transverse - v.y() * e.inverse_meridian * e.tan_latitude;
  m(0, 1) = v.x() * e.tan_latitude * e.inverse_meridian;
  m(0, 2) = -v.x() * e.inverse_transverse;
  m(1, 1) = v.z() * e.inverse_meridian;
  m(1, 2) = -v.y() * e.inverse_meridian;
  return m;
}

ErrorModel errorModel(const Earth& earth, const NavigationState& state, const Eigen::Vector3d& f_b) {
  const EarthPoint e = earth.at(state.coordinates);
  const Eigen::Vector3d& v = state.v_n;
  const Eigen::Vector3d omega_en = e.omega_en(v);
  const Eigen::Matrix3d by_v = transportByVelocity(e);
  const Eigen::Matrix3d by_p = transportByPosition(e, v);
  const Eigen::Matrix3d rate_by_p = earthRateByPosition(e);
  ErrorModel m;
  m.C = state.C_n_b();
  m.phi_phi = -skew(e.omega_ie + omega_en);
  m.phi_v = by_v;
  m.phi_p = rate_by_p + by_p;
  m.v_phi = skew(m.C * f_b);
  m.v_v = skew(v) * by_v - skew(2.0 * e.omega_ie + omega_en);
  m.v_p = skew(v) * (2.0 * rate_by_p + by_p);
  m.v_p(2, 1) -= e.gravity_by_north;
  m.v_p(2, 2) -= e.gravity_by_height;
  m.p_p = metricRate(e, v);
  return m;
}

Eigen::Matrix<double, kInertial, kInertial> denseF(const ErrorModel& m) {
  Eigen::Matrix<double, kInertial, kInertial> F = Eigen::Matrix<double, kInertial, kInertial>::Zero();
  F.block<3, 3>(kPhi, kPhi) = m.phi_phi;
  F.block<3, 3>(kPhi, kVelocity) = m.phi_v;
  F.block<3, 3>(kPhi, kPosition) = m.phi_p;
  F.block<3, 3>(kPhi, kGyroBias) = -m.C;
  F.block<3, 3>(kVelocity, kPhi) = m.v_phi;
  F.block<3, 3>(kVelocity, kVelocity) = m.v_v;
  F.block<3, 3>(kVelocity, kPosition) = m.v_p;
  F.block<3, 3>(kVelocity, kAccelerometerBias) = m.C;
  F.block<3, 3>(kPosition, kVelocity).setIdentity();
  F.block<3, 3>(kPosition, kPosition) = m.p_p;
  return F;
}

}  // namespace pos::ins
