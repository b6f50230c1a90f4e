#pragma once
/// What every motion has to keep: its derivatives are those of its position and attitude.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "pos/core/pose3.hpp"
#include "pos/sim/motion.hpp"

namespace pos::sim {

/// Central difference of sixth order; error about h^6 f^(7) / 140 plus rounding 1e-16 f / h.
template <class F>
auto derivative(F&& f, double t, double h) -> decltype(f(t)) {
  decltype(f(t)) d = 45.0 * (f(t + h) - f(t - h));
  d -= 9.0 * (f(t + 2 * h) - f(t - 2 * h));
  d += f(t + 3 * h) - f(t - 3 * h);
  return d / (60.0 * h);
}

/// The largest disagreements found between formulas and differences.
struct Disagreement {
  double velocity = 0.0;
  double acceleration = 0.0;
  double rate = 0.0;
  double angular_acceleration = 0.0;
  double travelled = 0.0;
  double rotation = 0.0;  ///< of R from an orthonormal matrix
  int compared = 0;
};

inline double distanceToBreak(const Motion& motion, double t) {
  double nearest = std::min(t, motion.duration() - t);
  for (const double b : motion.breaks()) nearest = std::min(nearest, std::abs(t - b));
  return nearest;
}

/// At `count` times over the motion's length, away from its breaks.
inline Disagreement disagreement(const Motion& motion, int count, double h) {
  Disagreement worst;
  const auto keep = [](double& largest, double value) { largest = std::max(largest, value); };
  for (int i = 0; i < count; ++i) {
    const double t = motion.duration() * (i + 0.37) / count;
    if (distanceToBreak(motion, t) < 3.5 * h) continue;
    const Kinematics body = motion.at(t);
    const auto at = [&](auto member) {
      return [&motion, member](double s) { return (motion.at(s).*member).eval(); };
    };
    const auto p = [&](double s) -> Eigen::Vector3d { return motion.at(s).p_map - body.p_map; };
    keep(worst.velocity, (derivative(p, t, h) - body.v_map).norm());
    keep(worst.acceleration, (derivative(at(&Kinematics::v_map), t, h) - body.a_map).norm());
    const auto turned = [&](double s) -> Eigen::Vector3d {
      return rotationVector(
          Eigen::Quaterniond((body.R_map_body.transpose() * motion.at(s).R_map_body).eval()));
    };
    keep(worst.rate, (derivative(turned, t, h) - body.omega_body).norm());
    keep(worst.angular_acceleration,
         (derivative(at(&Kinematics::omega_body), t, h) - body.alpha_body).norm());
    const double way = motion.travelled(t);
    const double speed = derivative([&](double s) { return motion.travelled(s) - way; }, t, h);
    keep(worst.travelled, std::abs(speed - body.v_map.dot(body.R_map_body.col(0))));
    keep(worst.rotation,
         (body.R_map_body.transpose() * body.R_map_body - Eigen::Matrix3d::Identity()).norm());
    ++worst.compared;
  }
  return worst;
}

/// Position, attitude and way do not jump anywhere.
inline void expectContinuous(const Motion& motion) {
  for (const double t : motion.breaks()) {
    constexpr double kAside = 1e-7;
    const Kinematics before = motion.at(t - kAside);
    const Kinematics after = motion.at(t + kAside);
    const double reach = 2.1 * kAside;
    EXPECT_LE((after.p_map - before.p_map).norm(),
              reach * std::max(before.v_map.norm(), after.v_map.norm()) + 1e-11)
        << t;
    EXPECT_LE((after.R_map_body - before.R_map_body).norm(),
              2 * reach * std::max(before.omega_body.norm(), after.omega_body.norm()) + 1e-11)
        << t;
    EXPECT_NEAR(motion.travelled(t + kAside), motion.travelled(t - kAside), 1e-5) << t;
  }
  EXPECT_TRUE(std::is_sorted(motion.breaks().begin(), motion.breaks().end()));
  for (const double t : motion.breaks()) {
    EXPECT_GT(t, 0.0);
    EXPECT_LT(t, motion.duration());
  }
}

}  // namespace pos::sim
