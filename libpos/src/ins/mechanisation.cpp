#include "pos/ins/mechanisation.hpp"

#include "pos/core/pose3.hpp"

namespace pos::ins {
namespace {

/// The rotation of a vector of less than 0.1 rad by its series, exact to the last bit but one: a sample of an
/// inertial unit turns less, and sines cost more than all the rest (bench/sins).
Eigen::Quaterniond smallRotation(const Eigen::Vector3d& w) {
  const double h2 = 0.25 * w.squaredNorm();  // half the angle, squared
  if (h2 > 2.5e-3) return quaternionFromRotationVector(w);
  const double cosine = 1.0 - h2 * (0.5 - h2 * (1.0 / 24.0 - h2 * (1.0 / 720.0 - h2 / 40320.0)));
  const double sinc = 1.0 - h2 * (1.0 / 6.0 - h2 * (1.0 / 120.0 - h2 * (1.0 / 5040.0 - h2 / 362880.0)));
  const Eigen::Vector3d v = 0.5 * sinc * w;
  return {cosine, v.x(), v.y(), v.z()};
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

ImuIncrement compensated(const ImuIncrement& now, const ImuIncrement& previous) {
  ImuIncrement out = now;
  const Eigen::Vector3d& a = now.angle;
  const Eigen::Vector3d& v = now.velocity;
  out.angle += previous.angle.cross(a) / 12.0;
  out.velocity += (previous.angle.cross(v) + previous.velocity.cross(a)) / 12.0;
  return out;
}

NavigationState stepped(const Earth& earth, const NavigationState& state, const ImuIncrement& increment) {
  const double dt = increment.dt;
  if (dt == 0.0) return state;
  const EarthPoint here = earth.at(state.coordinates);
  const Eigen::Vector3d omega_in = here.omega_ie + here.omega_en(state.v_n);
  // Axes turn while the force acts: half the turn of the body, half that of n the other way.
  const Eigen::Vector3d dv_b = increment.velocity + 0.5 * increment.angle.cross(increment.velocity);
  const Eigen::Vector3d dv_n = state.q_n_b * dv_b;
  const Eigen::Vector3d dv_force = dv_n - (0.5 * dt * omega_in).cross(dv_n);  // below 1e-5 rad: first order
  const Eigen::Vector3d gravity(0.0, 0.0, -here.gravity);
  const auto coriolis = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return (2.0 * here.omega_ie + here.omega_en(v)).cross(v);
  };
  const Eigen::Vector3d v_half = state.v_n + 0.5 * (dv_force + dt * (gravity - coriolis(state.v_n)));

  NavigationState next;
  next.v_n = state.v_n + dv_force + dt * (gravity - coriolis(v_half));
  // On the way metric and Earth rate change by half the way over the Earth's radius: 1e-8 at 10 m/s and 100
  // Hz.
  next.coordinates = state.coordinates + (0.5 * dt * (state.v_n + next.v_n)).cwiseQuotient(here.metric);
  const Eigen::Vector3d omega_middle = here.omega_ie + here.omega_en(v_half);
  next.q_n_b =
      (smallRotation(-dt * omega_middle) * state.q_n_b * smallRotation(increment.angle)).normalized();
  return next;
}

NavigationRates navigationRates(const Earth& earth, const NavigationState& state,
                                const Eigen::Vector3d& omega_ib_b, const Eigen::Vector3d& f_b) {
  const EarthPoint here = earth.at(state.coordinates);
  const Eigen::Vector3d omega_en = here.omega_en(state.v_n);
  const Eigen::Matrix3d C = state.C_n_b();
  return {
      C * skew(omega_ib_b) - skew(here.omega_ie + omega_en) * C,
      C * f_b - (2.0 * here.omega_ie + omega_en).cross(state.v_n) - Eigen::Vector3d(0.0, 0.0, here.gravity),
      state.v_n.cwiseQuotient(here.metric)};
}

Eigen::Vector3d metresBetween(const Earth& earth, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return (to - from).cwiseProduct(earth.at(0.5 * (from + to)).metric);
}

}  // namespace pos::ins
