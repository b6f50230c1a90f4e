/// Facts of a real log that ships with Debian's mrpt-common, found out with MRPT's own tools.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "pos/io/log_info.hpp"
#include "rawlog_samples.hpp"

namespace pos::io {
namespace {

const std::filesystem::path kDatasets = "/usr/share/mrpt/datasets";

#define NEEDS_DATASETS()                   \
  if (!std::filesystem::exists(kDatasets)) \
  GTEST_SKIP() << "install mrpt-common to run this test: no " << kDatasets

TEST(UwbDemoLog, HoldsWhatIsKnownOfIt) {
  NEEDS_DATASETS();
  const ReadLog log = readWhole((kDatasets / "uwb_ro-localization_demo.rawlog").string());
  EXPECT_FALSE(log.end.damaged);
  EXPECT_EQ(log.end.objects, 686U);
  std::set<std::size_t> pairs;
  std::set<std::size_t> with_ranges;
  int scans = 0;
  int odometry = 0;
  for (std::size_t i = 0; i < log.measurements.size(); ++i) {
    const auto& reading = log.measurements[i].reading;
    scans += std::holds_alternative<Scan2D>(reading) ? 1 : 0;
    odometry += std::holds_alternative<OdometryIncrement>(reading) ? 1 : 0;
    ASSERT_FALSE(std::holds_alternative<WheelTicks>(reading));
    ASSERT_FALSE(std::holds_alternative<WheelSpeeds>(reading));
    if (!log.frames[i]) continue;
    pairs.insert(*log.frames[i]);
    if (std::holds_alternative<BeaconRange>(reading)) with_ranges.insert(*log.frames[i]);
  }
  EXPECT_EQ(pairs.size(), 342U);
  EXPECT_EQ(with_ranges.size(), 336U);  // 338 frames hold ranges, but in two of them all three are zero
  EXPECT_EQ(log.tally.refused.at("range is zero or negative"), 6U);
  for (const std::size_t missing : {51U, 167U, 226U, 333U}) EXPECT_FALSE(with_ranges.contains(missing));
  EXPECT_EQ(scans, 343);
  EXPECT_EQ(odometry, 342);
  EXPECT_EQ(log.tally.refused.at("encoder counters that are not credible (uninitialised fields)"), 342U);
}

TEST(UwbDemoLog, PairStampsRiseBySomeASecond) {
  NEEDS_DATASETS();
  const auto stamps = frameStamps((kDatasets / "uwb_ro-localization_demo.rawlog").string()).stamps;
  ASSERT_EQ(stamps.size(), 342U);
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    EXPECT_GT(seconds(stamps[i] - stamps[i - 1]), 1.0);
    EXPECT_LT(seconds(stamps[i] - stamps[i - 1]), 1.2);
  }
}

TEST(LogInfo, SummarisesTheUwbDemo) {
  NEEDS_DATASETS();
  const LogInfo info = logInfo((kDatasets / "uwb_ro-localization_demo.rawlog").string());
  EXPECT_EQ(info.format, LogFormat::ActionsAndFrames);
  EXPECT_EQ(info.pairs, 342U);
  ASSERT_EQ(info.anchors.size(), 3U);
  EXPECT_EQ(info.anchors[0].count, 337U);
  EXPECT_NEAR(seconds(info.duration()), 363.0, 3.0);
  ASSERT_EQ(info.sensors.size(), 3U);
  EXPECT_NEAR(info.sensors[2].rate, 0.94, 0.03);
}

TEST(LogInfo, ExplainsEveryLogThatShipsWithMrpt) {
  NEEDS_DATASETS();
  int logs = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kDatasets)) {
    if (entry.path().extension() != ".rawlog") continue;
    SCOPED_TRACE(entry.path());
    const LogInfo info = logInfo(entry.path().string());
    EXPECT_FALSE(info.end.damaged) << info.end.message;
    EXPECT_GT(info.end.objects, 0U);
    EXPECT_GT(info.measurements + info.tally.skipped.size() + info.tally.refused.size(), 0U);
    EXPECT_FALSE(toText(info).empty());
    ++logs;
  }
  EXPECT_GT(logs, 5);
}

TEST(LogInfo, FindsGapRateAndStepsBackInTime) {
  const ScratchFolder folder;
  writeLog(folder.file("i.rawlog"), {{at(0), "uwb", rangeTo(4, 2.0)},
                                     {at(1), "uwb", rangeTo(4, 3.0)},
                                     {at(5), "uwb", rangeTo(4, 9.0)},
                                     {at(4), "uwb", rangeTo(9, 1.0)}});
  const LogInfo info = logInfo(folder.file("i.rawlog"));
  ASSERT_EQ(info.sensors.size(), 1U);
  EXPECT_EQ(info.sensors[0].largest_gap, durationFromSeconds(4.0));
  EXPECT_EQ(info.sensors[0].backwards, 1U);
  EXPECT_DOUBLE_EQ(info.sensors[0].rate, 0.6);
  ASSERT_EQ(info.anchors.size(), 2U);
  EXPECT_DOUBLE_EQ(info.anchors[0].range_median, 3.0);
  EXPECT_DOUBLE_EQ(info.anchors[0].range_max, 9.0);
  EXPECT_NE(toText(info).find("1 back in time"), std::string::npos);
}

}  // namespace
}  // namespace pos::io
