#include "pos/ins/mechanisation.hpp"

#include <gtest/gtest.h>

#include "pos/core/pose3.hpp"

namespace pos::ins {
namespace {

const Eigen::Vector3d kMine(1.95, 0.61, -350.0);  // longitude, latitude rad, height m

Eigen::Quaterniond attitude(double yaw, double pitch, double roll) {
  return Pose3::fromXyzYawPitchRoll(0, 0, 0, yaw, pitch, roll).rotation;
}

/// What a perfect unit at rest feels over dt.
ImuIncrement atRest(const Earth& earth, const NavigationState& state, double dt) {
  const EarthPoint here = earth.at(state.coordinates);
  const Eigen::Quaterniond q_b_n = state.q_n_b.conjugate();
  const Eigen::Vector3d omega = q_b_n * here.omega_ie;
  const Eigen::Vector3d force = q_b_n * Eigen::Vector3d(0.0, 0.0, here.gravity);
  return {omega * dt, force * dt, dt};
}

TEST(Strapdown, APerfectUnitAtRestStaysWithinAMillimetreForAMinute) {
  const Earth earth = Earth::ellipsoid();
  for (const auto& q : {attitude(0, 0, 0), attitude(2.1, 0.3, -0.4), attitude(-3.0, -1.2, 2.9)}) {
    const NavigationState start{q, Eigen::Vector3d::Zero(), kMine};
    NavigationState state = start;
    const ImuIncrement felt = atRest(earth, start, 0.01);
    for (int i = 0; i < 6000; ++i) state = stepped(earth, state, felt);
    EXPECT_LT(metresBetween(earth, start.coordinates, state.coordinates).head<2>().norm(), 1e-3);
    EXPECT_LT((state.C_n_b() * state.C_n_b().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_LT(state.q_n_b.angularDistance(q), 1e-7);
  }
}

TEST(Strapdown, IgnoringTheEarthRateTiltsTheSolutionByIt) {
  const Earth earth = Earth::ellipsoid();
  const NavigationState start{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), kMine};
  ImuIncrement felt = atRest(earth, start, 0.01);
  felt.angle.setZero();  // gyros that do not feel the Earth
  NavigationState state = start;
  for (int i = 0; i < 1000; ++i) state = stepped(earth, state, felt);
  const Eigen::Vector3d turned = rotationVector(state.q_n_b);
  const Eigen::Vector3d expected = -10.0 * earth.at(kMine).omega_ie;
  EXPECT_NEAR((turned - expected).norm(), 0.0, 5e-8);  // the tilt makes it move, and n turns with it
}

TEST(Strapdown, ZeroTimeChangesNothing) {
  const Earth earth = Earth::ellipsoid();
  const NavigationState start{attitude(1, 0.1, 0.2), {1, 2, 3}, kMine};
  const NavigationState same = stepped(earth, start, {{1, 1, 1}, {2, 2, 2}, 0.0});
  EXPECT_EQ(same.v_n, start.v_n);
  EXPECT_EQ(same.coordinates, start.coordinates);
  EXPECT_EQ(same.q_n_b.coeffs(), start.q_n_b.coeffs());
}

/// A level circle on the flat Earth in closed form: exact increments of rate and force.
double circleError(double dt) {
  const Earth earth = Earth::flat(9.80665);
  const double speed = 3.0;
  const double rate = 0.5;
  NavigationState state{Eigen::Quaterniond::Identity(), {speed, 0, 0}, Eigen::Vector3d::Zero()};
  const double radius = speed / rate;
  const ImuIncrement felt{{0, 0, rate * dt}, {0, speed * rate * dt, 9.80665 * dt}, dt};
  const int steps = static_cast<int>(std::lround(10.0 / dt));
  for (int i = 0; i < steps; ++i) state = stepped(earth, state, felt);
  const Eigen::Vector3d truth(radius * std::sin(5.0), radius * (1.0 - std::cos(5.0)), 0.0);
  return (state.coordinates - truth).norm();
}

TEST(Strapdown, ACircleIsOfSecondOrderInTheStep) {
  const double coarse = circleError(0.02);
  const double fine = circleError(0.01);
  EXPECT_LT(fine, 2e-4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);
}

/// Coning: the body's z axis goes round a cone of half angle a at rate w; exact increments by the formula
/// q(t) of the motion, so that only the strapdown's approximation remains.
double coningDrift(bool compensate) {
  const Earth earth = Earth::flat();
  const double a = 0.02;
  const double w = 2.0 * M_PI * 5.0;
  const double dt = 0.01;
  // w_b of q = [cos a/2, sin a/2 cos wt, sin a/2 sin wt, 0]
  const auto integral = [&](double t0, double t1) -> Eigen::Vector3d {
    return {std::sin(a) * (std::cos(w * t1) - std::cos(w * t0)),
            std::sin(a) * (std::sin(w * t1) - std::sin(w * t0)),
            -2.0 * w * std::pow(std::sin(a / 2), 2) * (t1 - t0)};
  };
  NavigationState state{Eigen::Quaterniond(std::cos(a / 2), std::sin(a / 2), 0, 0), {0, 0, 0}, {0, 0, 0}};
  ImuIncrement previous{integral(-dt, 0.0), {0, 0, 0}, dt};
  const int steps = 2000;
  for (int i = 0; i < steps; ++i) {
    const ImuIncrement now{integral(i * dt, (i + 1) * dt), {0, 0, 0}, dt};
    state = stepped(earth, state, compensate ? compensated(now, previous) : now);
    previous = now;
  }
  const double t = steps * dt;
  const Eigen::Quaterniond truth(std::cos(a / 2), std::sin(a / 2) * std::cos(w * t),
                                 std::sin(a / 2) * std::sin(w * t), 0.0);
  return truth.angularDistance(state.q_n_b);
}

TEST(Strapdown, TwoSampleCompensationTakesAwayTheConingDrift) {
  const double plain = coningDrift(false);
  const double better = coningDrift(true);
  EXPECT_GT(plain, 5e-4);
  EXPECT_LT(better, 0.03 * plain);
}

TEST(Strapdown, ATiltErrorSwingsWithSchulersPeriod) {
  const Earth earth = Earth::ellipsoid();
  const Eigen::Vector3d equator(0.0, 0.0, 0.0);
  NavigationState state{attitude(0.0, 1e-4, 0.0), Eigen::Vector3d::Zero(), equator};
  const NavigationState level{Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero(), equator};
  const double dt = 1.0;
  double first_zero = 0.0;  // of the east velocity after the start: half a period
  double previous = 0.0;
  for (int i = 1; i < 4000 && first_zero == 0.0; ++i) {
    state = stepped(earth, state, atRest(earth, level, dt));
    state.coordinates.z() = 0.0;  // the vertical channel is unstable by nature: held
    state.v_n.z() = 0.0;
    if (i > 10 && previous * state.v_n.x() <= 0.0) first_zero = i * dt;
    previous = state.v_n.x();
  }
  EXPECT_NEAR(2.0 * first_zero / 60.0, 84.4, 0.5);
}

}  // namespace
}  // namespace pos::ins
