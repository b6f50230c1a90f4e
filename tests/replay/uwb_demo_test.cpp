// The configurations of configs/uwb_demo with the log of Debian's mrpt-common.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "replay/figures.hpp"

namespace pos::replay {
namespace {

namespace fs = std::filesystem;

constexpr int kSeeds = 10;

class UwbDemo : public ::testing::Test {
 protected:
  void SetUp() override {
    if (datasets().empty())
      GTEST_SKIP() << "install mrpt-common to run this test: its UWB demo log is not there";
  }

  static std::string config(const std::string& name) {
    return source("configs/uwb_demo/" + name + ".yaml").string();
  }

  /// The configuration with one estimator ten times, seeds 1 to 10: one pass over the log instead of ten.
  std::string seeded(const std::string& name, const std::string& estimator) const {
    YAML::Node run = YAML::LoadFile(config(name));
    YAML::Node copies;
    for (const YAML::Node& entry : run["estimators"]) {
      if (entry["name"].as<std::string>() != estimator) continue;
      for (int seed = 1; seed <= kSeeds; ++seed) {
        YAML::Node copy = YAML::Clone(entry);
        copy["name"] = estimator + "_seed" + std::to_string(seed);
        copy["seed"] = seed;
        copies.push_back(copy);
      }
    }
    run["estimators"] = copies;
    run["map"] = source("maps/uwb_demo/map.yaml").string();
    std::ostringstream text;
    text << run;
    bench_.write(estimator + ".yaml", text.str() + "\n");
    return estimator + ".yaml";
  }

  Bench bench_;
};

TEST_F(UwbDemo, SixEstimatorsKeepTheirFigures) {
  expectFigures("uwb_demo/compare", {replayed(bench_, {config("compare")})});
}

TEST_F(UwbDemo, ParticleFiltersKeepTheirFiguresOverTenSeeds) {
  expectFigures("uwb_demo/compare seeds", {replayed(bench_, {seeded("compare", "mcl_ranges")}),
                                           replayed(bench_, {seeded("compare", "mcl_scan")})});
}

TEST_F(UwbDemo, ThreadsAndAPackedCopyOfTheLogChangeNoByte) {
  fs::copy_file(datasets() / "uwb_ro-localization_demo.rawlog", bench_.folder() / "demo.rawlog");
  const auto run = [&](const std::string& folder, const std::string& jobs) {
    const RunResult result =
        bench_.pos({"replay", config("compare"), "--log", "demo.rawlog", "--out", folder, "--jobs", jobs});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  };
  run("alone", "1");
  run("many", "4");
  ASSERT_EQ(bench_.pos({"convert", "log", "demo.rawlog", "--to", "cache"}).exit_code, 0);
  EXPECT_THAT(run("copy", "0"), ::testing::ContainsRegex("packed copy .*demo.rawlog.cache"));
  int files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(bench_.folder() / "alone")) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".tum") && !name.ends_with(".csv")) continue;
    ++files;
    EXPECT_EQ(bench_.read("alone/" + name), bench_.read("many/" + name)) << name;
    EXPECT_EQ(bench_.read("alone/" + name), bench_.read("copy/" + name)) << name;
  }
  EXPECT_EQ(files, 13);  // two an estimator, and the events
}

TEST_F(UwbDemo, TheLogAsMcapGivesTheSameFigures) {
  const fs::path log = datasets() / "uwb_ro-localization_demo.rawlog";
  ASSERT_EQ(bench_.pos({"convert", "log", log.string(), "--out", "demo.mcap"}).exit_code, 0);
  YAML::Node plain = YAML::LoadFile(config("compare"));  // a truth by index needs the rawlog
  plain.remove("truth");
  plain["map"] = source("maps/uwb_demo/map.yaml").string();
  std::ostringstream plain_text;
  plain_text << plain;
  bench_.write("plain.yaml", plain_text.str() + "\n");
  const auto positions = [&](const std::string& file, const std::string& folder) {
    const RunResult run = bench_.pos({"replay", "plain.yaml", "--log", file, "--out", folder});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    std::vector<double> numbers;
    std::istringstream text(bench_.read(folder + "/range_odometry.tum"));
    for (std::string word; text >> word;) {
      if (std::isdigit(word.back()) != 0) numbers.push_back(std::stod(word));  // but for the head
    }
    return numbers;
  };
  const std::vector<double> of_rawlog = positions(log.string(), "rawlog");
  const std::vector<double> of_mcap = positions("demo.mcap", "mcap");
  ASSERT_EQ(of_rawlog.size(), of_mcap.size());
  ASSERT_GT(of_rawlog.size(), 1000U);
  for (std::size_t i = 0; i < of_rawlog.size(); ++i) EXPECT_NEAR(of_rawlog[i], of_mcap[i], 1e-6) << i;
}

TEST_F(UwbDemo, AHeadingWrongByAnyAngleIsFound) {
  std::vector<json> runs;
  for (const char* yaw : {"0", "90", "180"}) {
    const std::string start = std::string("estimators.range_odometry.start.yaw_deg=") + yaw;
    runs.push_back(replayed(bench_, {config("unknown_heading"), "--set", start}));
  }
  expectFigures("uwb_demo/unknown_heading", runs);
}

TEST_F(UwbDemo, AnUnknownStartIsFound) {
  expectFigures("uwb_demo/unknown_start", {replayed(bench_, {config("unknown_start")})});
}

/// x and y of the last row of <estimator>.tum.
std::pair<double, double> lastPosition(const std::string& tum) {
  std::istringstream lines(tum);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] != '#') last = line;
  }
  double t = 0.0;
  double x = NAN;
  double y = NAN;
  std::istringstream(last) >> t >> x >> y;
  return {x, y};
}

/// x and y of the reference's last pose; the demo's reference is relative to the start (2, 4).
std::pair<double, double> lastTruth() {
  std::istringstream rows(contents(datasets() / "uwb_ro-localization_demo_GT.txt"));
  double index = 0.0;
  double x = NAN;
  double y = NAN;
  double phi = 0.0;
  for (double i, a, b, c; rows >> i >> a >> b >> c;) std::tie(index, x, y, phi) = std::tie(i, a, b, c);
  return {x + 2.0, y + 4.0};
}

TEST_F(UwbDemo, TheScanFindsItsPlaceInTheWholeRoomForNineSeedsOfTen) {
  (void)replayed(bench_, {seeded("unknown_start", "mcl_scan"), "--out", "run"});
  const auto [x, y] = lastTruth();
  int found = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto [x_end, y_end] =
        lastPosition(bench_.read("run/mcl_scan_seed" + std::to_string(seed) + ".tum"));
    found += std::hypot(x_end - x, y_end - y) < 0.5 ? 1 : 0;
  }
  expectFigure("uwb_demo/unknown_start seeds", "mcl_scan", "found at the end",
               static_cast<double>(found) / kSeeds);
}

}  // namespace
}  // namespace pos::replay
