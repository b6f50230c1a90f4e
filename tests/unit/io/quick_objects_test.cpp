/// The quick way of reading an observation beside MRPT's own.
#include "../../../libpos/src/io/quick_objects.hpp"

#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservationBeaconRanges.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/serialization/CArchive.h>

#include <string>

#include "pos/core/random.hpp"

namespace pos::io {
namespace {

using mrpt::obs::CObservationBeaconRanges;
using mrpt::obs::CObservationIMU;
using mrpt::serialization::CSerializable;

std::string stored(const CSerializable& object) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << object;
  return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

std::span<const std::uint8_t> bytesOf(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

CObservationIMU anImu(RandomStream& random) {
  CObservationIMU imu;
  for (double& value : imu.rawMeasurements) value = random.normal();
  for (bool& there : imu.dataIsPresent) there = random.uniform() < 0.5;
  imu.sensorPose =
      mrpt::poses::CPose3D(random.normal(), random.normal(), random.normal(), random.normal(), 0.3, -0.2);
  imu.timestamp = mrpt::Clock::fromDouble(1.7e9 + random.uniform());
  imu.sensorLabel = "imu of the mast";
  return imu;
}

CObservationBeaconRanges someRanges(RandomStream& random, int count) {
  CObservationBeaconRanges ranges;
  ranges.minSensorDistance = 0.25F;
  ranges.maxSensorDistance = 300.0F;
  ranges.stdError = 0.125F;
  for (int i = 0; i < count; ++i) {
    CObservationBeaconRanges::TMeasurement range;
    range.sensorLocationOnRobot = {random.normal(), random.normal(), random.normal()};
    range.sensedDistance = static_cast<float>(10.0 * random.uniform());
    range.beaconID = i - 3;
    ranges.sensedData.push_back(range);
  }
  ranges.auxEstimatePose = {1.0, 2.0, 0.5};
  ranges.timestamp = mrpt::Clock::fromDouble(1.7e9 + random.uniform());
  ranges.sensorLabel = "uwb;tag=7";
  return ranges;
}

/// The object read quickly, stored again: the same bytes. `slot` is used from call to call.
void expectSame(const CSerializable& object, CSerializable::Ptr& slot) {
  const std::string bytes = stored(object) + "more";
  EXPECT_EQ(readQuickly(bytesOf(bytes), slot), bytes.size() - 4);
  ASSERT_NE(slot, nullptr);
  EXPECT_EQ(stored(*slot), stored(object));
}

TEST(QuickObjects, ReadWhatMrptWroteAndUseTheirObjectsAgain) {
  RandomStream random(7, 0);
  CSerializable::Ptr imu;
  CSerializable::Ptr ranges;
  for (int i = 0; i < 50; ++i) {
    expectSame(anImu(random), imu);
    expectSame(someRanges(random, i % 9), ranges);
  }
  const CSerializable* const before = imu.get();
  expectSame(anImu(random), imu);
  EXPECT_EQ(imu.get(), before);
  const CSerializable::Ptr held = imu;  // by somebody else: left alone
  expectSame(anImu(random), imu);
  EXPECT_NE(imu.get(), held.get());
}

TEST(QuickObjects, LeaveToMrptWhatIsCutOtherOrMany) {
  RandomStream random(7, 0);
  CSerializable::Ptr slot;
  for (const std::string& whole : {stored(anImu(random)), stored(someRanges(random, 3))}) {
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_EQ(readQuickly(bytesOf(whole.substr(0, size)), slot), 0U) << size;
    std::string other_version = whole;
    other_version[static_cast<std::size_t>(whole[0] & 0x7F) + 1] = 1;
    EXPECT_EQ(readQuickly(bytesOf(other_version), slot), 0U);
    std::string no_end = whole;
    no_end.back() = 0;
    EXPECT_EQ(readQuickly(bytesOf(no_end), slot), 0U);
  }
  EXPECT_EQ(readQuickly(bytesOf(stored(someRanges(random, 17))), slot), 0U);
  EXPECT_EQ(readQuickly(bytesOf(stored(mrpt::obs::CObservationOdometry())), slot), 0U);
}

}  // namespace
}  // namespace pos::io
