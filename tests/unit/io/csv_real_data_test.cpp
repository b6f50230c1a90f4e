// The three public sets that configs/import describes, where a folder with them is at hand.
#include <gtest/gtest.h>

#include <cstdlib>

#include "pos/io/csv_import.hpp"

namespace pos::io {
namespace {

class CsvRealData : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("POS_DATA_DIR");
    if (folder == nullptr) {
      GTEST_SKIP() << "set POS_DATA_DIR to a folder that holds plaza1, lias_fast and hanyang_los_b4 as CSV";
    }
    data_ = folder;
  }

  ImportResult imported(const std::string& mapping, const std::string& set) const {
    return importCsv(std::filesystem::path(POS_SOURCE_DIR) / "configs/import" / (mapping + ".yaml"),
                     data_ / set);
  }

  std::filesystem::path data_;
};

template <class R>
std::size_t countOf(const ImportResult& result) {
  std::size_t count = 0;
  for (const Measurement& m : result.measurements) count += std::holds_alternative<R>(m.reading) ? 1 : 0;
  return count;
}

bool sorted(const ImportResult& result) {
  return std::is_sorted(result.measurements.begin(), result.measurements.end(),
                        [](const Measurement& a, const Measurement& b) { return a.stamp < b.stamp; });
}

TEST_F(CsvRealData, PlazaHasItsCountsAndLength) {
  const ImportResult result = imported("plaza", "plaza1");
  EXPECT_EQ(countOf<OdometryIncrement>(result), 9657U);
  EXPECT_EQ(countOf<BeaconRange>(result), 3529U);
  EXPECT_EQ(result.map.anchors.size(), 4U);
  EXPECT_EQ(result.truth->poses.size(), 9658U);
  EXPECT_FALSE(result.truth->has_yaw || result.truth->has_z);
  EXPECT_TRUE(sorted(result));
  EXPECT_EQ(result.counts.ranges_to_unknown_anchors, 0U);
  double driven = 0.0;
  for (const Measurement& m : result.measurements) {
    if (const auto* odometry = std::get_if<OdometryIncrement>(&m.reading)) {
      driven += odometry->increment.translation().norm();
    }
  }
  EXPECT_NEAR(driven, 1860.0, 60.0);  // the set's description: 1.86 km
}

TEST_F(CsvRealData, LiasHasItsCountsAndTagPlaces) {
  const ImportResult result = imported("lias", "lias_fast");
  EXPECT_EQ(countOf<BeaconRange>(result), 64725U);
  EXPECT_EQ(result.map.anchors.size(), 8U);
  EXPECT_EQ(result.truth->poses.size(), 5745U);
  EXPECT_TRUE(result.truth->has_yaw && result.truth->has_z);
  ASSERT_EQ(result.tags.size(), 3U);
  EXPECT_NEAR((result.tags[1].second - result.tags[0].second).norm(), 0.28, 0.01);
  for (const Measurement& m : result.measurements) {
    ASSERT_TRUE(std::get<BeaconRange>(m.reading).tag_body);
  }
  EXPECT_TRUE(sorted(result));
}

TEST_F(CsvRealData, HanyangHasItsCountsPowersAndFixes) {
  const ImportResult result = imported("hanyang", "hanyang_los_b4");
  EXPECT_EQ(countOf<BeaconRange>(result), 7253U);
  EXPECT_EQ(countOf<GnssFix>(result), 1600U);
  EXPECT_EQ(result.map.anchors.size(), 4U);
  EXPECT_EQ(result.truth->poses.size(), 1599U);
  EXPECT_FALSE(result.truth->has_yaw);
  EXPECT_TRUE(sorted(result));
  std::size_t fixed = 0;
  for (const Measurement& m : result.measurements) {
    if (const auto* fix = std::get_if<GnssFix>(&m.reading)) {
      fixed += fix->quality == GnssFix::Quality::RtkFixed ? 1 : 0;
    } else {
      ASSERT_TRUE(std::get<BeaconRange>(m.reading).first_path_power_dbm);
    }
  }
  EXPECT_EQ(fixed, 1252U);
}

}  // namespace
}  // namespace pos::io
