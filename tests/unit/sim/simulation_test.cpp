#include "pos/sim/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "pos/core/error.hpp"
#include "pos/sim/scenario.hpp"
#include "support/sample_vehicles.hpp"

namespace pos::sim {
namespace {

/// 1 m/s along x for 10 s, with a quick and a slow late sensor.
Scenario scenario() {
  Scenario scenario;
  scenario.vehicle = samples::fourWheelSteered();
  scenario.motion = SegmentMotionConfig{.start = {.speed = 1.0}, .segments = {{.drive = {.duration = 10.0}}}};
  ImuModel imu;
  imu.errors = automotiveMems();
  UwbConfig uwb;
  uwb.timing = {.rate = 10.0, .latency = 0.5};
  uwb.tags = {{.id = 1, .mount = "tag_left"}};
  scenario.sensors = {{.name = "imu", .model = imu}, {.name = "uwb", .model = uwb}};
  return scenario;
}

std::shared_ptr<const map::TunnelMap> anchors() {
  map::TunnelMap map;
  map.anchors = {{.id = 7, .name = "A", .p_map = {20.0, 3.0, 2.0}}};
  return std::make_shared<const map::TunnelMap>(map);
}

std::vector<Delivery> all(Simulation simulation) {
  std::vector<Delivery> deliveries;
  while (auto delivery = simulation.next()) deliveries.push_back(std::move(*delivery));
  return deliveries;
}

std::vector<Delivery> of(const std::vector<Delivery>& deliveries, const std::string& sensor) {
  std::vector<Delivery> own;
  std::copy_if(deliveries.begin(), deliveries.end(), std::back_inserter(own),
               [&](const Delivery& d) { return d.measurement.sensor == sensor; });
  return own;
}

double rangeIn(const Delivery& delivery) {
  return std::get<BeaconRange>(delivery.measurement.reading).range;
}

}  // namespace

TEST(Simulation, MergesSensorsByArrivalNotByStamp) {
  const auto deliveries = all(Simulation(scenario(), anchors(), 1));
  for (std::size_t i = 1; i < deliveries.size(); ++i)
    EXPECT_GE(deliveries[i].arrival, deliveries[i - 1].arrival);
  const auto late = of(deliveries, "uwb");
  ASSERT_EQ(late.size(), 101u);
  EXPECT_EQ(late[0].arrival - late[0].measurement.stamp, durationFromSeconds(0.5));
  EXPECT_EQ(deliveries.front().measurement.sensor, "imu");
}

TEST(Simulation, EqualArrivalsComeInTheOrderOfTheList) {
  Scenario both = scenario();
  std::get<UwbConfig>(both.sensors[1].model).timing.latency = 0.0;
  Scenario turned = both;
  std::swap(turned.sensors[0], turned.sensors[1]);
  const auto sensorAt = [](const std::vector<Delivery>& deliveries, double t) {
    const Stamp stamp = stampFromSeconds(Scenario{}.start) + durationFromSeconds(t);
    return std::find_if(deliveries.begin(), deliveries.end(),
                        [&](const Delivery& d) { return d.arrival == stamp; })
        ->measurement.sensor;
  };
  EXPECT_EQ(sensorAt(all(Simulation(both, anchors(), 1)), 5.0), "imu");
  EXPECT_EQ(sensorAt(all(Simulation(turned, anchors(), 1)), 5.0), "uwb");
}

TEST(Simulation, ASensorDoesNotDependOnTheOthersAndEachSeedIsItsOwn) {
  Scenario alone = scenario();
  alone.sensors.erase(alone.sensors.begin());
  const auto together = of(all(Simulation(scenario(), anchors(), 1)), "uwb");
  const auto single = all(Simulation(alone, anchors(), 1));
  const auto other = all(Simulation(alone, anchors(), 2));
  ASSERT_EQ(together.size(), single.size());
  ASSERT_EQ(other.size(), single.size());
  for (std::size_t i = 0; i < single.size(); ++i) {
    EXPECT_EQ(rangeIn(together[i]), rangeIn(single[i]));
    EXPECT_NE(rangeIn(other[i]), rangeIn(single[i]));
  }
}

TEST(Simulation, MountsOfTheVehicleCarryTheSensors) {
  const auto ranges = of(all(Simulation(scenario(), anchors(), 1)), "uwb");
  EXPECT_EQ(std::get<BeaconRange>(ranges[0].measurement.reading).tag_body,
            samples::fourWheelSteered().mount("tag_left").p_body);
}

TEST(Simulation, TruthIsSampledAtARateWithBothEnds) {
  Scenario shortened = scenario();
  shortened.duration = 2.05;
  const Simulation simulation(shortened, anchors(), 1);
  const Truth truth = sampledTruth(simulation, 10.0);
  ASSERT_EQ(truth.poses.size(), 22u);
  EXPECT_EQ(truth.poses.front().stamp, simulation.start());
  EXPECT_EQ(truth.poses.back().stamp, simulation.end());
  EXPECT_NEAR(truth.poses[10].T_map_body.translation.x(), 1.0, 1e-12);
  EXPECT_NEAR(truth.poses.back().T_map_body.translation.x(), 2.05, 1e-9);
  for (std::size_t i = 1; i < truth.poses.size(); ++i)
    EXPECT_GT(truth.poses[i].stamp, truth.poses[i - 1].stamp);
  EXPECT_THROW(TruthSampler(simulation, 0.0), ConfigError);
}

TEST(Simulation, ADurationOfItsOwnEndsTheSensors) {
  Scenario shortened = scenario();
  shortened.duration = 3.0;
  EXPECT_EQ(of(all(Simulation(shortened, anchors(), 1)), "imu").size(), 300u);
  EXPECT_EQ(of(all(Simulation(shortened, anchors(), 1)), "uwb").size(), 31u);
}

TEST(Simulation, WallsBetweenTagAndAnchorSilenceIt) {
  Scenario walled = scenario();
  walled.rock = {.source = RockConfig::Source::Outlines,
                 .open_spaces = {{{-5.0, -2.0}, {15.0, -2.0}, {15.0, 2.0}, {-5.0, 2.0}}}};
  EXPECT_TRUE(of(all(Simulation(walled, anchors(), 1)), "uwb").empty());
}

TEST(Simulation, RoadwaysOfTheMapLetRangesThroughAndRockBesideThemDoesNot) {
  map::TunnelMap mine = *anchors();
  mine.name = "mine";
  map::Roadway roadway{.id = "level", .width = 7.0};
  roadway.centreline = {{.p_map = {-5.0, 0.0, 0.0}}, {.p_map = {30.0, 0.0, 0.0}}};
  mine.roadways = {roadway};
  mine.anchors.push_back({.id = 8, .name = "B", .p_map = {5.0, 20.0, 2.0}});
  Scenario rocky = scenario();
  rocky.rock.source = RockConfig::Source::Roadways;
  std::map<AnchorId, int> heard;
  for (const Delivery& d : of(all(Simulation(rocky, std::make_shared<const map::TunnelMap>(mine), 1)), "uwb"))
    ++heard[std::get<BeaconRange>(d.measurement.reading).anchor];
  EXPECT_EQ(heard, (std::map<AnchorId, int>{{7, 101}})) << "8 stands in the rock";
  EXPECT_THROW(all(Simulation(rocky, anchors(), 1)), ConfigError) << "a map without roadways";
}

TEST(Simulation, WhatMapAndSensorsCannotServeIsRefusedByKey) {
  const auto keyOf = [](const Scenario& refused, const map::TunnelMap& map) {
    try {
      Simulation(refused, std::make_shared<const map::TunnelMap>(map), 1);
    } catch (const ConfigError& error) {
      return error.complaint().key;
    }
    return std::string("nothing");
  };
  EXPECT_EQ(keyOf(scenario(), {}), "sensors[1].type") << "no anchors";
  Scenario turning = scenario();
  turning.earth.kind = EarthKind::Level;
  EXPECT_EQ(keyOf(turning, *anchors()), "earth.kind") << "no latitude";
  Scenario laser = scenario();
  laser.sensors[1].model = LidarConfig{};
  EXPECT_EQ(keyOf(laser, *anchors()), "sensors[1].type") << "no grid";
  Scenario legs = scenario();
  legs.sensors[1].model = SupportLegSensor{};
  EXPECT_EQ(keyOf(legs, *anchors()), "sensors[1].type") << "no shearer";
}

TEST(Simulation, SupportsStandBesideTheConveyorsLineUntilTheShearerHasPassed) {
  Scenario face;
  face.vehicle = samples::guided();
  face.motion = ShearerConfig{.passes = 2};
  SupportLegSensor legs;
  legs.config.scanner.sigma_range = 0.0;
  legs.config.timing.rate = 1.0;
  face.sensors = {{.name = "lidar", .model = legs}};
  face.duration = 4412.0 + 1000.0;
  Simulation simulation(face, std::make_shared<const map::TunnelMap>(), 1);
  double first = 0.0;
  double last = -10.0;
  while (const auto delivery = simulation.next()) {
    const auto& scan = std::get<Scan2D>(delivery->measurement.reading);
    const Pose3 T_map_body = simulation.truthPoseAt(delivery->measurement.stamp);
    const Eigen::Vector3d leg = T_map_body * (scan.T_body_sensor * Eigen::Vector3d(scan.ranges[0], 0, 0));
    const double t = seconds(delivery->measurement.stamp - simulation.start());
    if (t < 100.0) first = leg.x();
    if (t > 4412.0 + 900.0) last = std::max(last, leg.x());
  }
  EXPECT_NEAR(first, -4.0, 1e-5) << "4 m west of the first line";
  EXPECT_NEAR(last, -2.0, 1e-5) << "two advances later, behind the shearer of the second pass";
}

}  // namespace pos::sim
