// `pos campaign` as a user runs it: the same bytes however the runs were spread, resumed or interrupted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <array>

#include "replay/figures.hpp"

namespace pos::replay {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::array kResults{"campaign.json", "campaign.csv",  "runs.csv",
                              "moments.csv",   "campaign.html", "manifest.json"};

class Campaign : public ::testing::Test {
 protected:
  void SetUp() override {
    if (datasets().empty())
      GTEST_SKIP() << "install mrpt-common to run this test: its UWB demo log is not there";
  }

  /// The demo's campaign with few particles: what is tested here is not the filter.
  std::vector<std::string> command(const std::vector<std::string>& more,
                                   const std::string& runs = "5") const {
    std::vector<std::string> words{"campaign", config_,
                                   "--runs",   runs,
                                   "--set",    "estimators.mcl_ranges.particles.max=200",
                                   "--set",    "estimators.mcl_ranges.particles.min=100"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  RunResult run(const std::vector<std::string>& more, const std::string& runs = "5") const {
    return bench_.pos(command(more, runs));
  }
  void expectSameResults(const std::string& one, const std::string& other) const {
    for (const char* file : kResults) {
      EXPECT_FALSE(bench_.read(one + "/" + file).empty()) << one << "/" << file;
      EXPECT_EQ(bench_.read(one + "/" + file), bench_.read(other + "/" + file)) << file;
    }
    for (const auto& record : fs::directory_iterator(bench_.folder() / one / "runs")) {
      const std::string name = "/runs/" + record.path().filename().string();
      EXPECT_EQ(bench_.read(one + name), bench_.read(other + name)) << name;
    }
  }
  void expectRefusal(const std::vector<std::string>& words, int exit_code, const std::string& text) const {
    const RunResult result = bench_.pos(words);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_LE(result.errLines(), 25);
  }

  const std::string config_ = source("configs/uwb_demo/campaign.yaml").string();
  Bench bench_;
};

TEST_F(Campaign, ResultsDoNotDependOnThreadsOrParts) {
  ASSERT_EQ(run({"--jobs", "1", "--out", "one"}).exit_code, 0);
  ASSERT_EQ(run({"--jobs", "3", "--out", "three"}).exit_code, 0);
  expectSameResults("one", "three");
  ASSERT_EQ(run({"--shard", "1/2", "--out", "a"}).exit_code, 0);
  EXPECT_EQ(bench_.read("a/campaign.json"), "") << "a part is not judged alone";
  expectRefusal({"campaign", "merge", "a", "--out", "merged"}, 5, "2 of 5 runs are missing");
  EXPECT_FALSE(fs::exists(bench_.folder() / "merged"));
  ASSERT_EQ(run({"--shard", "2/2", "--out", "b"}).exit_code, 0);
  const RunResult merge = bench_.pos({"campaign", "merge", "b", "a", "--out", "merged"});
  ASSERT_EQ(merge.exit_code, 0) << merge.err;
  expectSameResults("one", "merged");
}

TEST_F(Campaign, PartsMayShareAFolder) {
  ASSERT_EQ(run({"--out", "one"}).exit_code, 0);
  ASSERT_EQ(run({"--shard", "1/2", "--out", "shared"}).exit_code, 0);
  ASSERT_EQ(run({"--shard", "2/2", "--out", "shared"}).exit_code, 0);
  ASSERT_EQ(bench_.pos({"campaign", "merge", "shared", "--out", "shared", "--force"}).exit_code, 0);
  expectSameResults("one", "shared");
}

TEST_F(Campaign, OnlyMissingRunsAreDoneAgain) {
  ASSERT_EQ(run({"--out", "one"}).exit_code, 0);
  const std::string before = bench_.read("one/campaign.json");
  const fs::path kept = bench_.folder() / "one/runs/000001.json";
  const auto written = fs::last_write_time(kept);
  fs::remove(bench_.folder() / "one/runs/000003.json");
  bench_.write("one/runs/000004.json", "{\"format\": \"pos.camp");  // cut short by a full disk
  const RunResult again = run({"--out", "one"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("2 runs in"));
  EXPECT_EQ(bench_.read("one/campaign.json"), before);
  EXPECT_EQ(fs::last_write_time(kept), written);
  ASSERT_EQ(run({"--out", "one"}, "6").exit_code, 0);
  EXPECT_EQ(at(json::parse(bench_.read("one/campaign.json")), "campaign.runs_done"), 6.0);
}

TEST_F(Campaign, AnInterruptKeepsWhatIsDone) {
  const RunResult whole = run({"--out", "whole"}, "4");
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const RunResult stopped =
      bench_.posStopped(command({"--jobs", "1", "--out", "cut", "--verbose"}, "4"), "run 0 is done", SIGINT);
  EXPECT_EQ(stopped.exit_code, 130);
  EXPECT_THAT(stopped.err, HasSubstr("of 4 runs are done; the same command"));
  const json cut = json::parse(bench_.read("cut/campaign.json"));
  EXPECT_GE(at(cut, "campaign.runs_done"), 1.0);
  EXPECT_LT(at(cut, "campaign.runs_done"), 4.0);
  ASSERT_EQ(run({"--out", "cut"}, "4").exit_code, 0);
  expectSameResults("whole", "cut");
}

TEST_F(Campaign, TheWorstRunRepeatsAloneWithItsCommand) {
  ASSERT_EQ(run({"--out", "one"}).exit_code, 0);
  const json all = json::parse(bench_.read("one/campaign.json"));
  const json& worst = all.at("estimators").at("mcl_ranges").at("metrics").at("errors.xy.rmse").at("worst");
  std::istringstream words(worst.at("repeat").get<std::string>());
  std::string word;
  std::vector<std::string> arguments;
  words >> word;
  EXPECT_EQ(word, "pos");
  while (words >> word) arguments.push_back(word);
  arguments.push_back("--json");
  const RunResult alone = bench_.pos(arguments);
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(at(json::parse(alone.out), "estimators.mcl_ranges.errors.xy.rmse"),
            worst.at("value").get<double>());
}

TEST_F(Campaign, WithoutAFolderTheSameTableIsPrinted) {
  const RunResult plain = run({}, "2");
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(run({"--out", "one"}, "2").out, plain.out);
  EXPECT_EQ(run({"--json"}, "2").out, bench_.read("one/campaign.json"));
}

TEST_F(Campaign, ALimitOverTheRunsIsKeptOrMissed) {
  EXPECT_EQ(run({"--out", "one", "--require", "worst:rmse_xy<100"}, "2").exit_code, 0);
  const RunResult missed = run({"--out", "one", "--require", "mean_rmse_xy<0.001"}, "2");
  EXPECT_EQ(missed.exit_code, 4);
  EXPECT_THAT(missed.err, HasSubstr("campaign.mean_rmse_xy"));
}

TEST_F(Campaign, BadInputIsToldBeforeAnythingRuns) {
  expectRefusal(command({"--shard", "3/2", "--out", "x"}), 2, "there is no such part of a campaign");
  expectRefusal(command({"--shard", "0/2", "--out", "x"}), 2, "i from 1 to n");
  expectRefusal(command({"--shard", "two", "--out", "x"}), 2, "i/n");
  expectRefusal(command({"--shard", "1/2"}), 2, "needs a folder");
  expectRefusal(command({"--shard", "1/2", "--out", "x", "--require", "rmse_xy<1"}), 2, "not judged alone");
  expectRefusal(command({}, "0"), 2, "a campaign needs runs");
  expectRefusal(command({}, "many"), 2, "not a whole number");
  expectRefusal(command({"--jobs", "1000000"}), 2, "threads");
  expectRefusal(command({"--require", "wurst:rmse_xy<1"}), 2, "worst");
  expectRefusal(command({"--require", "rmze_xy<1"}), 2, "did you mean rmse_xy?");
  expectRefusal(command({"--set", "campaign.baseline=nobody"}), 3, "the baseline is none of the estimators");
  expectRefusal(command({"--set", "campaign.step_s=0.001"}), 3, "too many moments");
  expectRefusal({"campaign"}, 2, "no configuration");
  EXPECT_FALSE(fs::exists(bench_.folder() / "x"));
}

TEST_F(Campaign, FoldersOfDifferentCampaignsAreKeptApart) {
  ASSERT_EQ(run({"--out", "one"}, "2").exit_code, 0);
  expectRefusal(command({"--out", "one", "--seed", "9"}, "2"), 3, "it differs in the seed (1, here 9)");
  expectRefusal(command({"--out", "one", "--set", "faults.range_outlier_probability=0.2"}, "2"), 3,
                "it differs in the configuration");
  ASSERT_EQ(run({"--out", "other", "--seed", "9"}, "2").exit_code, 0);
  ASSERT_EQ(run({"--out", "longer"}, "3").exit_code, 0);
  expectRefusal({"campaign", "merge", "one", "other"}, 3, "not parts of one campaign");
  expectRefusal({"campaign", "merge", "one", "longer"}, 3, "3 runs");
  bench_.write("notes/readme.txt", "mine");
  expectRefusal({"campaign", "merge", "one", "notes"}, 5, "it has no manifest.json");
  expectRefusal({"campaign", "merge", "one", "--out", "notes"}, 3, "holds no campaign");
  expectRefusal(command({"--out", "notes", "--force"}, "2"), 3, "holds no campaign");
  EXPECT_EQ(bench_.read("notes/readme.txt"), "mine");
  bench_.write("one/runs/000001.json", bench_.read("other/runs/000001.json"));
  expectRefusal({"campaign", "merge", "one"}, 3, "belongs to another campaign");
  EXPECT_EQ(run({"--out", "other", "--force"}, "2").exit_code, 0);
}

// Needs no recording.
TEST(CampaignOfAScenario, IsSimulatedAnewInEveryRunAndTheSameOnAnyThread) {
  const Bench bench;
  const std::string config = source("configs/experiments/double_lane_baseline.yaml").string();
  const auto campaign = [&](const std::string& jobs, const std::string& folder) {
    return bench.pos({"campaign", config, "--runs", "6", "--jobs", jobs, "--out", folder, "--require",
                      "worst:rmse_xy<0.2", "--require", "max_rmse_xy<0.3"});
  };
  const RunResult one = campaign("1", "one");
  ASSERT_EQ(one.exit_code, 0) << one.err;
  ASSERT_EQ(campaign("2", "two").exit_code, 0);
  for (const char* file : kResults)
    EXPECT_EQ(bench.read(std::string("one/") + file), bench.read(std::string("two/") + file));
  const json all = json::parse(bench.read("one/campaign.json"));
  EXPECT_FALSE(all.at("campaign").at("recorded").get<bool>());
  const json& metrics = all.at("estimators").at("lively").at("metrics");
  EXPECT_GT(metrics.at("errors.xy.rmse").at("std").get<double>(), 0.0) << "every run has noise of its own";
}

}  // namespace
}  // namespace pos::replay
