// Every scenario that comes with the project: it loads, runs, and its log says the same after a way through
// an MRPT file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

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
    map_ = std::make_shared<const map::TunnelMap>(
        scenario_.map ? loadMap(*scenario_.map, "/usr/share/mrpt", {}) : map::TunnelMap{});
  }

  /// The first seconds of motion (or of the scenario, where it never rests) as measurements.
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

INSTANTIATE_TEST_SUITE_P(All, ScenarioFile, ::testing::ValuesIn(files("configs/scenarios")), nameOf);

}  // namespace
}  // namespace pos::io
