// Every scenario that comes with the project: it loads, runs, and its log says the same after a way through
// an MRPT file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "pos/core/angle.hpp"
#include "pos/io/grid_io.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/scenario_yaml.hpp"
#include "pos/sim/simulation.hpp"
#include "rawlog_samples.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

constexpr double kShort = 3.0;  // s of each scenario

std::vector<fs::path> files(const std::string& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(fs::path(POS_SOURCE_DIR) / folder)) {
    if (entry.path().extension() == ".yaml") found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string nameOf(const ::testing::TestParamInfo<fs::path>& info) {
  return info.param.stem().string();
}

class ScenarioFile : public ::testing::TestWithParam<fs::path> {
 protected:
  ScenarioFile() : scenario_(loadScenario(GetParam(), {}, "/usr/share/mrpt")) {
    const GridLoader grids = [](const fs::path& file) { return loadGrid(file.string()); };
    map_ = std::make_shared<const map::TunnelMap>(
        scenario_.map ? loadMap(*scenario_.map, "/usr/share/mrpt", grids) : map::TunnelMap{});
  }

  /// The first seconds of the scenario as measurements.
  std::vector<Measurement> simulated(std::uint64_t seed) const {
    sim::Scenario shortened = scenario_;
    shortened.duration = kShort;
    sim::Simulation simulation(shortened, map_, seed);
    std::vector<Measurement> measurements;
    Stamp last{};
    while (auto delivery = simulation.next()) {
      EXPECT_GE(delivery->arrival, last) << "deliveries are in order of arrival";
      last = delivery->arrival;
      measurements.push_back(std::move(delivery->measurement));
    }
    return measurements;
  }

  sim::Scenario scenario_;
  std::shared_ptr<const map::TunnelMap> map_;
  ScratchFolder folder_;
};

TEST_P(ScenarioFile, SaysWhereItComesFromAndWhatWasChosen) {
  EXPECT_EQ(scenario_.name, GetParam().stem().string());
  EXPECT_NE(scenario_.source, "");
  EXPECT_NE(scenario_.inferred, "");
}

TEST_P(ScenarioFile, WrittenOutItReadsBackToTheSame) {
  const std::string once = resolvedYaml(scenario_);
  EXPECT_EQ(resolvedYaml(scenarioFrom(parseYaml(once, "/elsewhere/run.yaml"), {})), once);
}

TEST_P(ScenarioFile, SameSeedGivesTheSameLogByteForByteAndAnotherSeedAnother) {
  for (const auto& [name, seed] : {std::pair{"a", 1U}, {"b", 1U}, {"c", 2U}}) {
    writeLog(folder_.file(name), simulated(seed));
  }
  EXPECT_FALSE(contentOf(folder_.file("a")).empty());
  EXPECT_EQ(contentOf(folder_.file("a")), contentOf(folder_.file("b")));
  EXPECT_NE(contentOf(folder_.file("a")), contentOf(folder_.file("c")));
}

TEST_P(ScenarioFile, EverythingSurvivesTheRawlogAndNoTruthIsInIt) {
  const std::vector<Measurement> made = simulated(1);
  ASSERT_FALSE(made.empty());
  writeLog(folder_.file("log"), made);
  const ReadLog log = readWhole(folder_.file("log"));
  EXPECT_FALSE(log.end.damaged);
  EXPECT_TRUE(log.tally.refused.empty());
  ASSERT_EQ(log.measurements.size(), made.size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_EQ(log.measurements[i].sensor, made[i].sensor);
    EXPECT_LE(std::abs(seconds(log.measurements[i].stamp - made[i].stamp)), 1e-7);
    ASSERT_EQ(readingName(log.measurements[i].reading), readingName(made[i].reading));
    EXPECT_FALSE(std::holds_alternative<PoseTruth>(made[i].reading));
  }
}

sim::Simulation simulationOf(const std::string& name) {
  const sim::Scenario scenario =
      loadScenario(fs::path(POS_SOURCE_DIR) / "configs/scenarios" / (name + ".yaml"), {}, {});
  const GridLoader grids = [](const fs::path& file) { return loadGrid(file.string()); };
  return {scenario, std::make_shared<const map::TunnelMap>(loadMap(*scenario.map, {}, grids)), 1};
}

/// What the papers say, or what follows from it, of where a run ends.
struct KnownEnd {
  std::string scenario;
  double duration;  // s
  Eigen::Vector3d p_map;
  double tolerance;  // m, half of the last digit
};

TEST(ScenarioFacts, RunsEndWhereThePapersSay) {
  const std::vector<KnownEnd> known{
      {"a1_double_lane_shift", 30.0, {23.945, 0.0, 0.0}, 5e-4},
      {"a2_quarter_turn", 35.0, {10.0, -12.42, 0.0}, 5e-3},
      {"be1_curve", 40.0, {2.008, 4.805, 0.0}, 5e-4},
      {"be2_loop", 75.0, {0.40, 0.0, 0.0}, 5e-3},
      {"circle_nlos", 72.83, {20.0, 0.0, 0.0}, 1e-6},
      {"portal_run_known_r", 75.0, {374.35, 0.0, -13.94}, 5e-3},
      {"mock_shaft", 400.0, {0.0, 0.0, 0.0}, 5e-3},
      {"shearer_selection", 12364.0, {2.0, 350.0, 0.0}, 1e-6},
      {"shearer_bend_creep", 25600.0, {5.0, -0.976, 0.0}, 1e-6},
  };
  for (const KnownEnd& end : known) {
    const sim::Simulation simulation = simulationOf(end.scenario);
    EXPECT_NEAR(simulation.duration(), end.duration, 5e-3) << end.scenario;
    const Eigen::Vector3d p = simulation.truthAt(simulation.duration()).p_map;
    EXPECT_LT((p - end.p_map).cwiseAbs().maxCoeff(), end.tolerance) << end.scenario << " " << p.transpose();
  }
}

TEST(ScenarioFacts, TheLanesOfTheDoubleLaneShiftLieAsFarApartAsCalculated) {
  const sim::Simulation simulation = simulationOf("a1_double_lane_shift");
  EXPECT_NEAR(simulation.truthAt(16.0).p_map.y(), -1.568, 5e-4);
}

TEST(ScenarioFacts, TheQuarterTurnHasFourAnchorsOrMoreInSightOfEachTag) {
  sim::Simulation simulation = simulationOf("a2_quarter_turn");
  std::map<std::pair<Stamp, TagId>, int> heard;
  while (const auto delivery = simulation.next()) {
    const auto* range = std::get_if<BeaconRange>(&delivery->measurement.reading);
    if (range != nullptr) ++heard[{delivery->measurement.stamp, range->tag}];
  }
  EXPECT_EQ(heard.size(), 702u) << "two tags, 35 s at 10 Hz";
  const auto least = std::min_element(heard.begin(), heard.end(),
                                      [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto most = std::max_element(heard.begin(), heard.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  EXPECT_EQ(least->second, 4);
  EXPECT_EQ(most->second, 6);
  EXPECT_NEAR(simulation.truthAt(20.0).p_map.x(), 7.0, 5e-4);
}

/// Curves no tighter than the vehicle steers, at every 0.1 s of the motion.
TEST_P(ScenarioFile, TheVehicleCanSteerTheWholeWay) {
  if (scenario_.vehicle.max_steer <= 0.0) GTEST_SKIP() << "nothing steers";
  const std::unique_ptr<const sim::Motion> motion = sim::makeMotion(scenario_.motion);
  double sharpest = 0.0;
  for (double t = 0.05; t < motion->duration(); t += 0.1) {
    const sim::Kinematics body = motion->at(t);
    const double speed = body.v_map.norm();
    if (speed < 0.01) continue;
    sharpest = std::max(sharpest, std::abs(steerAngle(scenario_.vehicle, body.omega_body.z() / speed)));
  }
  EXPECT_LE(degrees(sharpest), degrees(scenario_.vehicle.max_steer) + 1e-6);
}

sim::Vehicle vehicleOf(const fs::path& file) {
  const std::string text = "schema: 1\nname: try\nvehicle_file: " + file.string() +
                           "\nmotion: {type: segments, segments: [{duration_s: 1}]}\n"
                           "sensors: [{name: imu, type: imu, mount: imu}]\n";
  return scenarioFrom(parseYaml(text, "/elsewhere/run.yaml"), {}).vehicle;
}

class VehicleFile : public ::testing::TestWithParam<fs::path> {};

TEST_P(VehicleFile, IsAVehicleThatAScenarioCanNameAndItsMountsSitOnIt) {
  const sim::Vehicle vehicle = vehicleOf(GetParam());
  EXPECT_EQ(vehicle.name, GetParam().stem().string());
  for (const sim::Mount& mount : vehicle.mounts) {
    EXPECT_LE(std::abs(mount.p_body.x() - vehicle.centre_x), 0.5 * vehicle.length) << mount.name;
    EXPECT_LE(std::abs(mount.p_body.y()), 0.5 * vehicle.width) << mount.name;
  }
}

TEST(VehicleFacts, VehiclesHaveThePapersFigures) {
  const fs::path folder = fs::path(POS_SOURCE_DIR) / "configs/vehicles";
  const sim::Vehicle wlr5a = vehicleOf(folder / "wlr5a.yaml");
  EXPECT_NEAR(wlr5a.rear_track + wlr5a.wheel_width, wlr5a.width, 1e-12);
  EXPECT_NEAR((wlr5a.mount("tag_left").p_body - wlr5a.mount("tag_right").p_body).y(), 0.75, 1e-15);
  const sim::Vehicle mine = vehicleOf(folder / "intelligent_mine_1.yaml");
  EXPECT_NEAR(mine.max_speed, 11.11, 5e-3);
  EXPECT_EQ(mine.width, 1.245);
  // The mock shaft's corners of 1.2 m on a wheelbase of 1.2 m: atan(1) = 45 degrees.
  EXPECT_NEAR(mine.max_steer, steerAngle(mine, 1.0 / 1.2), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(All, VehicleFile, ::testing::ValuesIn(files("configs/vehicles")), nameOf);
INSTANTIATE_TEST_SUITE_P(All, ScenarioFile, ::testing::ValuesIn(files("configs/scenarios")), nameOf);

}  // namespace
}  // namespace pos::io
