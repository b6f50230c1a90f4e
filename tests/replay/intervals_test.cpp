// Lock intervals in a replay, and locks with several vehicles, through the command.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "replay/figures.hpp"

namespace pos::replay {
namespace {

using ::testing::HasSubstr;

class Intervals : public ::testing::Test {
 protected:
  RunResult expectExit(const std::vector<std::string>& arguments, int code) const {
    RunResult run = bench_.pos(arguments);
    EXPECT_EQ(run.exit_code, code) << run.err;
    return run;
  }

  Bench bench_;
};

}  // namespace

TEST_F(Intervals, ARunSaysInWhichIntervalTheVehicleIs) {
  const std::string config = source("configs/experiments/intervals/be5.yaml").string();
  expectExit({"replay", config, "--out", "run", "--quiet"}, 0);
  const json summary = json::parse(bench_.read("run/summary.json"));
  expectFigures("experiments/intervals/be5", {summary});
  const std::string table = bench_.read("run/checked.intervals.csv");
  EXPECT_THAT(table, HasSubstr("stamp_s,state,roadway"));
  EXPECT_THAT(table, HasSubstr(",decided,main,"));
  const std::string events = bench_.read("run/events.csv");
  EXPECT_THAT(events, HasSubstr("interval_entry"));
  EXPECT_THAT(events, HasSubstr("interval_exit"));
  EXPECT_THAT(events, HasSubstr("branch_decided"));
  const std::string report = bench_.read("run/report.html");
  EXPECT_THAT(report, HasSubstr("Lock intervals"));
  EXPECT_THAT(report, HasSubstr("Time and distance along the road"));
  EXPECT_FALSE(bench_.read("run/figures/time_distance.svg").empty());
}

TEST_F(Intervals, IntoTheBranchItKeepsItsFigures) {
  expectFigures("experiments/intervals/be5_branch",
                {replayed(bench_, {source("configs/experiments/intervals/be5_branch.yaml").string()})});
}

/// Of 50 minutes the first 400 s and 800 m: the yard, the portal, the incline and the first chambers.
TEST_F(Intervals, AShiftBeginsWithFixesThatAreTakenAndErrorsThatAreAsTold) {
  expectFigures("experiments/intervals/shift_mine",
                {replayed(bench_, {source("configs/experiments/intervals/shift_mine.yaml").string(), "--set",
                                   "scenario.duration_s=400"})});
}

TEST_F(Intervals, AMapWithoutRoadwaysIsRefused) {
  const RunResult run = expectExit({"replay", source("configs/simulation/circle.yaml").string(), "--set",
                                    "intervals.merge=1", "--map", source("maps/uwb_demo/map.yaml").string()},
                                   3);
  EXPECT_THAT(run.err, HasSubstr("intervals need a map with roadways"));
}

TEST_F(Intervals, TrafficInTheShiftMineIsSafeAndItsLogSaysSo) {
  const std::string config = source("configs/locks/shift_mine.yaml").string();
  const json run = json::parse(
      expectExit(
          {"locks", "run", config, "--set", "traffic.requests=400", "--out", "locks", "--json", "--quiet"}, 0)
          .out);
  expectFigure("locks/shift_mine", "traffic", "opposing_s", at(run, "opposing_s"));
  expectFigure("locks/shift_mine", "traffic", "deadlocks", at(run, "deadlocks"));
  expectFigure("locks/shift_mine", "traffic", "lock_success_share", at(run, "lock_success_share"));
  expectFigure("locks/shift_mine", "traffic", "audit.waiting_s.mean", at(run, "audit.waiting_s.mean"));
  EXPECT_GE(at(run, "audit.requests"), 400);
  EXPECT_GT(at(run, "audit.doubts"), 0);
  const json again = json::parse(expectExit({"locks", "audit", "locks", "--json"}, 0).out);
  EXPECT_EQ(again, run.at("audit")) << "the log alone tells the same";
  EXPECT_THAT(bench_.read("locks/report.html"), HasSubstr("Time and distance along route shift"));
}

TEST_F(Intervals, AForgedLogIsFound) {
  const std::string config = source("configs/locks/shift_mine.yaml").string();
  expectExit({"locks", "run", config, "--set", "traffic.requests=30", "--out", "locks", "--quiet"}, 0);
  std::string log = bench_.read("locks/audit.csv");
  const std::size_t granted = log.find(",record,locked,");
  ASSERT_NE(granted, std::string::npos);
  const std::size_t begin = log.rfind('\n', granted) + 1;
  log.erase(begin, log.find('\n', granted) + 1 - begin);  // a lock that was never made
  bench_.write("locks/audit.csv", log);
  EXPECT_THAT(expectExit({"locks", "audit", "locks"}, 4).out, HasSubstr("!"));
}

TEST_F(Intervals, ARecordedVehicleWithoutLeaveIsSeen) {
  // One drives along the main road and into the branch, the other comes out of the branch: both do not fit.
  const auto row = [](int t, double x, double y) {
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(),
                  "%d %.3f %.3f 0 0 0 0 1 1e-4 0 0 1e-4 0 1e-4 0.04 0 0 0.04 0 0.04\n", t, x, y);
    return std::string(text.data());
  };
  std::string in;
  std::string out;
  const auto in_branch = [&](int t, double s) { return row(t, 251.0104 + 0.5 * s, 0.8660254 * s); };
  for (int t = 0; t < 270; ++t) in += t < 125 ? row(t, 2.0 * t, -1.25) : in_branch(t, 2.0 * (t - 125));
  for (int t = 115; t < 263; ++t) out += in_branch(t, 297.5 - 2.0 * (t - 115));
  bench_.write("in.tum", in);
  bench_.write("out.tum", out);
  const std::string map = contents(source("maps/interval_demo/map.yaml"));
  bench_.write("map.yaml",
               map.substr(0, map.find("\nroutes:")) +
                   "\nroutes:\n  - id: branch\n    legs:\n      - {roadway: main, from_m: 0, to_m: "
                   "251.0104}\n      - {roadway: branch, from_m: 0, to_m: 297.97}\n");
  bench_.write("locks.yaml",
               "schema: 1\nname: two\nmap: map.yaml\nvehicles:\n  - {file: in.tum, route: branch}\n"
               "  - {file: out.tum, route: branch, reversed: true}\n");
  const RunResult result = bench_.pos({"locks", "run", "locks.yaml", "--json", "--quiet"});
  ASSERT_FALSE(result.out.empty()) << result.err;
  const json run = json::parse(result.out);
  EXPECT_GT(at(run, "audit.granted"), 2);
  EXPECT_GT(at(run, "audit.trespasses"), 0);
  EXPECT_TRUE(run.at("opposing_s").is_null());
}

}  // namespace pos::replay
