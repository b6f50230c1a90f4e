#include "pos/sim/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/sample_vehicles.hpp"
#include "unit/sim/motion_checks.hpp"
#include "unit/sim/paper_motions.hpp"
#include "unit/sim/refusals.hpp"

namespace pos::sim {

TEST(Vehicles, EveryKindOfSteeringIsAccepted) {
  for (const Vehicle& vehicle : {samples::frontSteered(), samples::fourWheelSteered(),
                                 samples::differential(), samples::articulated(), samples::guided()}) {
    EXPECT_EQ(refusedKey([&] { return validated(vehicle); }), "accepted") << vehicle.name;
  }
}

TEST(Vehicles, AMissingMountIsNamedWithThoseThereAre) {
  EXPECT_EQ(refusedKey([] { return samples::fourWheelSteered().mount("gnss"); }), "mounts");
  Vehicle twice = samples::fourWheelSteered();
  twice.mounts.push_back(twice.mounts.front());
  EXPECT_EQ(refusedKey([&] { return validated(twice); }), "mounts");
  Vehicle none = samples::fourWheelSteered();
  none.wheel_radius = 0.0;
  EXPECT_EQ(refusedKey([&] { return validated(none); }), "wheel_radius");
}

TEST(Vehicles, VelocityOfAPointIsTheDerivativeOfItsPosition) {
  const auto motion = makeMotion(papers::loop());
  const Eigen::Vector3d p_body(0.5, -0.2, 0.9);
  for (const double t : {5.5, 20.0, 47.0}) {
    const auto place = [&](double s) { return pointPosition(motion->at(s), p_body); };
    const Kinematics body = motion->at(t);
    EXPECT_LT((derivative(place, t, 0.01) - body.R_map_body * pointVelocity(body, p_body)).norm(), 1e-11);
  }
}

TEST(Vehicles, OnALeftBendTheRightWheelIsFaster) {
  const auto motion = makeMotion(papers::circle());
  const Vehicle car = samples::frontSteered();
  const WheelPair wheels = wheelGroundSpeeds(car, motion->at(30.0));
  EXPECT_NEAR(wheels.left, 0.1 * (20.0 - 0.85), 1e-12);
  EXPECT_NEAR(wheels.right, 0.1 * (20.0 + 0.85), 1e-12);
}

TEST(Vehicles, SteeredWheelsRollTheWayTheirPointsGo) {
  const auto motion = makeMotion(papers::laneShift());
  const Kinematics body = motion->at(19.5);  // radius 2.46 m to the left
  const double radius = body.v_map.norm() / body.omega_body.z();
  const WheelPair wheels = wheelGroundSpeeds(samples::fourWheelSteered(), body);
  EXPECT_NEAR(wheels.left, body.omega_body.z() * std::hypot(radius - 0.95, 1.01), 1e-12);
  EXPECT_NEAR(wheels.right, body.omega_body.z() * std::hypot(radius + 0.95, 1.01), 1e-12);
  // The specification: four-wheel steer angle about 22 degrees.
  EXPECT_NEAR(degrees(steerAngle(samples::fourWheelSteered(), 1.0 / radius)), 22.0, 0.5);
}

TEST(Vehicles, SteerAnglesFollowTheGeometryOfTheirAxles) {
  EXPECT_NEAR(steerAngle(samples::frontSteered(), 1.0 / 3.0), 0.25 * kPi, 1e-12);
  EXPECT_NEAR(steerAngle(samples::frontSteered(), -1.0 / 3.0), -0.25 * kPi, 1e-12);
  EXPECT_NEAR(std::tan(0.5 * steerAngle(samples::articulated(), 0.2)), 0.34, 1e-12);
  EXPECT_EQ(steerAngle(samples::differential(), 5.0), 0.0);
}

}  // namespace pos::sim
