// The three public recordings, from their tables to the figures.
#include <gtest/gtest.h>

#include <set>

#include "replay/figures.hpp"

namespace pos::replay {
namespace {

namespace fs = std::filesystem;

class Recordings : public ::testing::Test {
 protected:
  void SetUp() override {
    if (recordings().empty()) {
      GTEST_SKIP() << "set POS_DATA_DIR to a folder that holds plaza1, lias_fast and hanyang_los_b4 as CSV";
    }
  }

  void convert(const std::string& mapping, const std::string& set, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{
        "convert", "csv",  source("configs/import/" + mapping + ".yaml"), "--data", recordings() / set,
        "--out",   mapping};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult run = bench_.pos(arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out, "");
  }

  json replay(const std::string& config, const std::string& folder,
              const std::string& system = "range_odometry") const {
    return replayed(bench_,
                    {source("configs/" + system + "/" + config + ".yaml"), "--log", folder + "/log.rawlog",
                     "--map", folder + "/map.yaml", "--truth", folder + "/truth.tum"});
  }

  void expectMeasurements(const std::string& mapping) const {
    const RunResult info = bench_.pos({"info", "--json", mapping + "/log.rawlog"});
    ASSERT_EQ(info.exit_code, 0) << info.err;
    expectFigure("import/" + mapping, "log", "measurements",
                 json::parse(info.out).at("measurements").get<double>());
  }

  Bench bench_;
};

TEST_F(Recordings, PlazaKeepsItsFigures) {
  convert("plaza", "plaza1");
  expectMeasurements("plaza");
  expectFigures("range_odometry/plaza", {replay("plaza", "plaza")});
  expectFigures("range_odometry/plaza_unknown_start", {replay("plaza_unknown_start", "plaza")});
}

TEST_F(Recordings, PlazaStandsEveryFifthRangeSpoilt) {
  std::vector<json> runs;
  for (const char* seed : {"1", "2", "3", "4", "5"}) {
    convert("plaza", "plaza1", {"--range-outliers", "0.2", "--seed", seed});
    runs.push_back(replay("plaza", "plaza"));
  }
  EXPECT_NE(runs[0].at("estimators").dump(), runs[1].at("estimators").dump())
      << "another seed spoils other ranges";
  expectFigures("range_odometry/plaza outliers", runs);
}

TEST_F(Recordings, HanyangKeepsItsFigures) {
  convert("hanyang", "hanyang_los_b4");
  expectMeasurements("hanyang");
  expectFigures("range_odometry/hanyang", {replay("hanyang", "hanyang")});
  expectFigures("uwb_imu/hanyang", {replay("hanyang", "hanyang", "uwb_imu")});
}

TEST_F(Recordings, LiasKeepsItsFigures) {
  convert("lias", "lias_fast");
  expectMeasurements("lias");
  expectFigures("range_odometry/lias", {replay("lias", "lias")});
}

TEST(Import, AFolderInTheFormatOfEuroc) {
  const Bench bench;
  fs::create_directories(bench.folder() / "mav0/imu0");
  fs::create_directories(bench.folder() / "mav0/state_groundtruth_estimate0");
  bench.write("mav0/imu0/data.csv",
              "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],"
              "a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n1403636579758555392,-0.1,0.1,0.02,8.1,-0.3,-2.4\n"
              "1403636579763555584,-0.1,0.1,0.02,8.1,-0.3,-2.4\n");
  bench.write("mav0/state_groundtruth_estimate0/data.csv",
              "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
              "q_RS_z []\n1403636579763555584,4.6,-1.7,0.7,0.6,0,-0.8,0\n");
  const RunResult run =
      bench.pos({"convert", "csv", source("configs/import/euroc.yaml"), "--data", "mav0", "--out", "euroc"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const RunResult info = bench.pos({"info", "--json", "euroc/log.rawlog"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  expectFigure("import/euroc", "log", "measurements", json::parse(info.out).at("measurements").get<double>());
  EXPECT_NE(bench.read("euroc/truth.tum").find("1403636579.763555584 4.6"), std::string::npos);
}

TEST(Table, EveryConfigurationHasItsFigures) {
  std::set<std::string> known;
  for (const Expected& row : expectedFigures()) {
    known.insert(row.run);
    EXPECT_LE(row.low, row.high) << row.run;
    EXPECT_FALSE(row.reason.empty()) << row.run;
  }
  int configs = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source("configs"))) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string run =
        fs::relative(entry.path(), source("configs")).replace_extension().generic_string();
    // Scenarios and vehicles are nothing to replay; the simulator's tests run every one of them.
    if (run.starts_with("scenarios/") || run.starts_with("vehicles/")) continue;
    ++configs;
    // without estimators: tests/unit/io/scenario_files_test.cpp runs every one of them
    if (run.starts_with("scenarios/") || run.starts_with("vehicles/")) continue;
    EXPECT_TRUE(known.contains(run)) << "no row of tests/replay/expected.csv judges configs/" << run
                                     << ".yaml";
  }
  EXPECT_GE(configs, 10);
}

}  // namespace
}  // namespace pos::replay
