#include "pos/ins/mechanisation.hpp"

#include "pos/core/pose3.hpp"

namespace pos::ins {

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
  const Eigen::Vector3d dv_force = quaternionFromRotationVector(-0.5 * dt * omega_in) * (state.q_n_b * dv_b);
  const Eigen::Vector3d gravity(0.0, 0.0, -here.gravity);
  const auto coriolis = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return (2.0 * here.omega_ie + here.omega_en(v)).cross(v);
  };
  const Eigen::Vector3d v_half = state.v_n + 0.5 * (dv_force + dt * (gravity - coriolis(state.v_n)));

  NavigationState next;
  next.v_n = state.v_n + dv_force + dt * (gravity - coriolis(v_half));
  const Eigen::Vector3d half_way = state.coordinates + (0.5 * dt * v_half).cwiseQuotient(here.metric);
  const EarthPoint middle = earth.at(half_way);
  next.coordinates = state.coordinates + (0.5 * dt * (state.v_n + next.v_n)).cwiseQuotient(middle.metric);
  const Eigen::Vector3d omega_middle = middle.omega_ie + middle.omega_en(v_half);
  next.q_n_b = (quaternionFromRotationVector(-dt * omega_middle) * state.q_n_b *
                quaternionFromRotationVector(increment.angle))
                   .normalized();
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
