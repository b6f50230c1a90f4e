#include <gtest/gtest.h>

#include "complaint.hpp"
#include "config_text.hpp"
#include "pos/io/overrides.hpp"
#include "pos/io/run_config.hpp"

namespace pos::io {
namespace {

using estimation::RangeOdometryConfig;
using pos::test::complaintOf;

RunConfig load(const std::vector<std::string>& overrides) {
  return runConfigFrom(applyOverrides(parseYaml(pos::test::kFullConfig, "/site/run.yaml"), overrides),
                       "/share");
}
Complaint refusal(const std::string& override_text) {
  return complaintOf([&] { return load({override_text}); });
}
const RangeOdometryConfig& second(const RunConfig& run) {
  return std::get<RangeOdometryConfig>(run.estimators[1].config);
}

TEST(ConfigOverrides, ItemsAreAddressedByIndexAndByName) {
  EXPECT_EQ(second(load({"estimators[1].range_sigma_m=0.3"})).range_sigma, 0.3);
  EXPECT_EQ(second(load({"estimators.range_odometry.range_sigma_m=0.3"})).range_sigma, 0.3);
  EXPECT_EQ(load({"faults.range_outlier_probability=0.25"}).faults.range_outlier_probability, 0.25);
}

TEST(ConfigOverrides, LaterOnesWin) {
  EXPECT_EQ(load({"seed=5", "seed=6"}).seed, 6u);
}

TEST(ConfigOverrides, NothingElseChanges) {
  RunConfig expected = load({});
  expected.record.max_rate = 3.0;
  EXPECT_EQ(load({"record.max_rate_hz=3"}), expected);
  EXPECT_EQ(load({"record={max_rate_hz: 3}"}), expected) << "a whole table";
}

TEST(ConfigOverrides, ListsAndTablesMayBeSet) {
  const RunConfig run = load({"estimators[1].tags=[{id: 4, x_m: 1, y_m: 2, z_m: 3}]", "sensors=[]"});
  EXPECT_EQ(second(run).tags.size(), 1u);
  EXPECT_EQ(second(run).tags[0].id, 4);
  EXPECT_TRUE(run.sensors.empty());
}

TEST(ConfigOverrides, KeysNotInTheFileMayBeSet) {
  const RunConfig run = runConfigFrom(
      applyOverrides(parseYaml("schema: 1\nname: r\nestimators: [{name: a, type: mcl}]\n", "/site/run.yaml"),
                     {"truth.format=log", "log.file='my log=1.rawlog'", "estimators.a.particles.max=900"}),
      "/share");
  EXPECT_EQ(run.truth->format, TruthSource::Format::Log);
  EXPECT_EQ(run.log->file, "/site/my log=1.rawlog");
  EXPECT_EQ(std::get<estimation::MclConfig>(run.estimators[0].config).particles.max, 900);
}

TEST(ConfigOverrides, UnknownKeyNamesTheArgument) {
  const Complaint complaint = refusal("estimators[1].range_sgima_m=0.3");
  EXPECT_EQ(toString(complaint.place), "--set estimators[1].range_sgima_m=0.3");
  EXPECT_EQ(complaint.key, "estimators[1].range_sgima_m");
  EXPECT_EQ(complaint.suggestion, "did you mean range_sigma_m?");
  EXPECT_EQ(refusal("falts.seed=1").suggestion, "did you mean faults?");
  EXPECT_EQ(refusal("sequencer.lag_ms=1").suggestion, "wrong unit: use lag_s");
}

TEST(ConfigOverrides, BadValueNamesTheArgument) {
  const Complaint complaint = refusal("estimators.range_odometry.range_sigma_m=0.3m");
  EXPECT_EQ(complaint.what, "this is not a number");
  EXPECT_EQ(toString(complaint.place), "--set estimators.range_odometry.range_sigma_m=0.3m");
  EXPECT_EQ(complaint.key, "estimators[1].range_sigma_m");
  EXPECT_EQ(refusal("seed=").got, "nothing");
  EXPECT_EQ(refusal("record.max_rate_hz=0").what, "the value is too small");
}

TEST(ConfigOverrides, WrongItemIsRefused) {
  EXPECT_EQ(refusal("estimators.range_odo.range_sigma_m=1").what, "the list has no item of this name");
  EXPECT_EQ(refusal("estimators.mcl1.seed=1").suggestion, "did you mean mcl-1?");
  EXPECT_EQ(refusal("estimators[4].seed=1").expected, "0 to 3");
  EXPECT_EQ(refusal("seed[0]=1").what, "this is not a list");
  EXPECT_EQ(refusal("seed.x=1").what, "there is no table to set 'x' in");
  EXPECT_EQ(refusal("sensors.UWB.use=true").expected, "an index, as in name[0]");
}

TEST(ConfigOverrides, TextThatSetsNothingIsRefused) {
  EXPECT_EQ(refusal("seed").what, "this sets nothing");
  EXPECT_EQ(refusal("=3").what, "this is not a key");
  EXPECT_EQ(refusal("a..b=3").what, "this is not a key");
  EXPECT_EQ(toString(refusal("seed=[1").place), "--set seed=[1");
}

}  // namespace
}  // namespace pos::io
