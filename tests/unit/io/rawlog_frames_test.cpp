/// Action/observation pairs: what belongs together, and when it happened.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileOutputStream.h>

#include "pos/core/error.hpp"
#include "rawlog_mrpt_samples.hpp"

namespace pos::io {
namespace {

TEST(RawlogFrames, GarbageInAnActionsEncoderFieldsIsRefusedForTheWholeLog) {
  const auto log = readBack({moved(0.1, true), frameOf({scanAt(0)}), moved(0.1, true), frameOf({scanAt(1)})});
  ASSERT_EQ(log.measurements.size(), 4U);
  EXPECT_EQ(log.tally.refused.at("encoder counters that are not credible (uninitialised fields)"), 2U);
  EXPECT_EQ(log.tally.refused.at("odometry velocities that are not credible (uninitialised fields)"), 2U);
}

TEST(RawlogFrames, OdometryOfAPairIsStampedWithTheFrameThatEndsItsMotion) {
  const auto log = readBack({frameOf({scanAt(0)}), moved(0.5), frameOf({scanAt(1)}), moved(0.6)});
  ASSERT_EQ(log.measurements.size(), 3U);
  EXPECT_EQ(log.frames[0], std::nullopt);  // before the first action: no pair
  EXPECT_EQ(log.measurements[1].stamp, at(1));
  EXPECT_EQ(log.measurements[1].sensor, "odometry");
  EXPECT_EQ(std::get<OdometryIncrement>(log.measurements[1].reading).interval, durationFromSeconds(1.0));
  EXPECT_EQ(log.frames[1], 0U);
  EXPECT_EQ(log.frames[2], 0U);
  EXPECT_EQ(log.measurements[2].sensor, "scan");
  ASSERT_EQ(log.tally.refused.size(), 1U);  // the last action: no frame ends its motion
  EXPECT_EQ(log.format, LogFormat::ActionsAndFrames);
}

TEST(RawlogFrames, RangesWithoutStampTakeTheScansStamp) {
  auto late = observed<CObservationIMU>(7);
  const auto log =
      readBack({moved(0.1), frameOf({late, rangesAt(INVALID_TIMESTAMP, {4.0F, 5.0F}), scanAt(3)})});
  ASSERT_EQ(log.measurements.size(), 4U);
  EXPECT_EQ(log.measurements[0].stamp, at(3));
  EXPECT_EQ(log.measurements[1].stamp, at(3));
  EXPECT_EQ(std::get<BeaconRange>(log.measurements[2].reading).anchor, 2);
  EXPECT_EQ(log.measurements[2].sensor, "range");
}

TEST(RawlogFrames, AFrameWithoutAnyStampIsCounted) {
  auto action = moved(0.1);
  (*action->begin())->timestamp = INVALID_TIMESTAMP;
  const auto log = readBack({action, frameOf({rangesAt(INVALID_TIMESTAMP, {4.0F})})});
  EXPECT_TRUE(log.measurements.empty());
  EXPECT_EQ(log.tally.refused.at("no time stamp"), 2U);
}

TEST(FrameStamps, AreOneForEachPair) {
  const ScratchFolder folder;
  const std::string path = folder.file("pairs.rawlog");
  {
    mrpt::io::CFileGZOutputStream file(path);
    auto archive = mrpt::serialization::archiveFrom(file);
    archive << *frameOf({scanAt(0)}) << *moved(1) << *frameOf({scanAt(2)}) << *moved(1)
            << *frameOf({scanAt(4)}) << *moved(1);
  }
  EXPECT_THAT(frameStamps(path).stamps, ::testing::ElementsAre(at(2), at(4)));
}

TEST(FrameStamps, OfADamagedLogAreThoseBeforeTheDamage) {
  const ScratchFolder folder;
  const std::string path = folder.file("cut.rawlog");
  {
    mrpt::io::CFileOutputStream file(path);
    auto archive = mrpt::serialization::archiveFrom(file);
    archive << *moved(1) << *frameOf({scanAt(2)}) << *moved(1) << *frameOf({scanAt(4)});
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 10);
  const FrameStamps frames = frameStamps(path);
  EXPECT_FALSE(frames.complete);
  EXPECT_THAT(frames.stamps, ::testing::ElementsAre(at(2)));
}

TEST(FrameStamps, AnObservationOnlyLogHasNone) {
  const ScratchFolder folder;
  writeLog(folder.file("o.rawlog"), oneOfEachKind());
  EXPECT_THROW(frameStamps(folder.file("o.rawlog")), DataError);
}

}  // namespace
}  // namespace pos::io
