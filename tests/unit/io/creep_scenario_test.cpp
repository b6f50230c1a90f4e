/// Creep from the sweeps of the shearer scenario: its own map, timetable, noise and errors of the scanner.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <variant>
#include <vector>

#include "pos/core/angle.hpp"
#include "pos/io/grid_io.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/scenario_yaml.hpp"
#include "pos/lidar/creep.hpp"
#include "pos/sim/scenario.hpp"
#include "pos/sim/simulation.hpp"

namespace pos::io {
namespace {

const std::filesystem::path kRoot = POS_SOURCE_DIR;

/// The scenario with nothing but the scanner that sees the gates, once a cycle from `phase` seconds on.
sim::Scenario gatesOnly(double phase) {
  sim::Scenario scenario = loadScenario(kRoot / "configs/scenarios/shearer_legs.yaml", {}, {});
  std::erase_if(scenario.sensors, [](const sim::SensorEntry& sensor) { return sensor.name != "roadway"; });
  sim::Timing& timing = std::get<sim::LidarConfig>(scenario.sensors.at(0).model).timing;
  timing.rate = 1.0 / 4412.0;
  timing.phase = phase;
  return scenario;
}

/// A stand at an end of the face.
struct Stood {
  double t = 0.0;  // s
  Pose3 T_map_body = {};
  Scan2D sweep = {};
};

std::vector<Stood> stands(double phase) {
  const sim::Scenario scenario = gatesOnly(phase);
  const auto gates = std::make_shared<const map::TunnelMap>(
      loadMap(*scenario.map, {}, [](const std::filesystem::path& grid) { return loadGrid(grid.string()); }));
  sim::Simulation simulation(scenario, gates, 1);
  std::vector<Stood> all;
  while (const auto delivery = simulation.next()) {
    const Measurement& measurement = delivery->measurement;
    all.push_back({seconds(measurement.stamp - simulation.start()), simulation.truthPoseAt(measurement.stamp),
                   std::get<Scan2D>(measurement.reading)});
  }
  return all;
}

sim::ShearerConfig shearerOfTheScenario() {
  return std::get<sim::ShearerConfig>(gatesOnly(0.0).motion);
}

/// Passes take 3540 s and end operations 872 s; the shearer stands at the end of either.
std::vector<lidar::Creep> creeps(const lidar::ScannerCalibration& calibration) {
  const sim::ShearerConfig config = shearerOfTheScenario();
  const auto shearer = sim::makeShearerMotion(config);
  const std::vector<Stood> before = stands(3540.0);
  const std::vector<Stood> after = stands(4410.0);
  const lidar::WallConfig walls{.calibration = calibration};
  std::vector<lidar::Creep> all;
  for (std::size_t i = 0; i < config.creep.size(); ++i) {
    const Pose2 truth = (inverse(before[i].T_map_body) * after[i].T_map_body).planar();
    const Pose2 guess{truth.x + 0.05, truth.y - 0.05, truth.yaw + radians(0.1)};
    const auto registration = lidar::registered(lidar::wallPoints(before[i].sweep, walls),
                                                lidar::wallPoints(after[i].sweep, walls), guess);
    all.push_back(lidar::creepOf(
        registration, {.R_face_body = before[i].T_map_body.rotation.toRotationMatrix(),
                       .stop_difference = shearer->stationAt(after[i].t) - shearer->stationAt(before[i].t)}));
  }
  return all;
}

}  // namespace

// Table 4 of the paper; the bar is 5 mm each.
TEST(CreepOfTheScenario, AllFiveDwellsWithinFiveMillimetres) {
  const std::vector<double> truth = shearerOfTheScenario().creep;
  const std::vector<lidar::Creep> found = creeps(lidar::ScannerCalibration::paper());
  ASSERT_EQ(found.size(), 5U);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_TRUE(found[i].usable) << i;
    EXPECT_NEAR(found[i].value, truth[i], 0.005) << i;
    EXPECT_LT(std::abs(found[i].value - truth[i]), 4.0 * found[i].sigma) << i;
    EXPECT_NEAR(found[i].advance, 1.0, 0.02) << i;
  }
}

// Uncalibrated, the first of them is 6 mm off.
TEST(CreepOfTheScenario, RawScannerStaysWithinTenMillimetres) {
  const std::vector<double> truth = shearerOfTheScenario().creep;
  const std::vector<lidar::Creep> found = creeps({});
  ASSERT_EQ(found.size(), 5U);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i].value, truth[i], 0.010) << i;
}

}  // namespace pos::io
