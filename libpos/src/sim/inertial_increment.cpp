#include <algorithm>

#include <Eigen/Geometry>

#include "pos/sim/imu.hpp"
#include "quadrature.hpp"

namespace pos::sim {
namespace {

/// Body's rate against the stars (rad/s) and specific force at a point (m/s^2), in body axes.
struct Sensed {
  Eigen::Vector3d rate;
  Eigen::Vector3d force;
};

Sensed sensedAt(const Kinematics& body, const Eigen::Vector3d& p_body, const Eigen::Vector3d& earth_rate_map,
                const Eigen::Vector3d& gravity_map) {
  const Eigen::Matrix3d R_body_map = body.R_map_body.transpose();
  const Eigen::Vector3d& omega = body.omega_body;
  const Eigen::Vector3d turning = omega.cross(p_body);
  const Eigen::Vector3d earth_rate = R_body_map * earth_rate_map;
  const Eigen::Vector3d v_point = R_body_map * body.v_map + turning;
  const Eigen::Vector3d a_point =
      R_body_map * (body.a_map - gravity_map) + body.alpha_body.cross(p_body) + omega.cross(turning);
  return {omega + earth_rate, a_point + 2.0 * earth_rate.cross(v_point)};
}

/// What a jump of speed or rate at `t` adds to the velocity increment: the moment of infinite acceleration.
Eigen::Vector3d jumpAt(const Motion& motion, const Eigen::Vector3d& p_body, double t) {
  constexpr double kAside = 2e-9;  // s
  const Kinematics before = motion.at(t - kAside);
  const Kinematics after = motion.at(t + kAside);
  const Eigen::Vector3d jump = after.R_map_body.transpose() * (after.v_map - before.v_map) +
                               (after.omega_body - before.omega_body).cross(p_body);
  // What a smooth motion does within 4 ns is no jump.
  return jump.squaredNorm() > 1e-12 ? jump : Eigen::Vector3d::Zero();
}

}  // namespace

InertialIncrement inertialIncrement(const Motion& motion, const Earth& earth, const Eigen::Vector3d& p_body,
                                    double from, double to) {
  constexpr double kPanel = 0.02;  // s
  InertialIncrement sum;
  // Over one interval of a vehicle the plumb line moves by less than 1e-12 of gravity's second difference.
  const Eigen::Vector3d gravity = earth.gravityAt(motion.at(0.5 * (from + to)).p_map);
  const auto add = [&](double a, double b) {
    threeNodes(a, b, kPanel, [&](double t, double weight) {
      const Sensed sensed = sensedAt(motion.at(t), p_body, earth.rotation(), gravity);
      sum.angle += weight * sensed.rate;
      sum.velocity += weight * sensed.force;
    });
  };
  const std::vector<double>& breaks = motion.breaks();
  double start = from;
  for (auto it = std::upper_bound(breaks.begin(), breaks.end(), from); it != breaks.end() && *it <= to;
       ++it) {
    add(start, *it);
    sum.velocity += jumpAt(motion, p_body, *it);
    start = *it;
  }
  if (start < to) add(start, to);
  return sum;
}

}  // namespace pos::sim
