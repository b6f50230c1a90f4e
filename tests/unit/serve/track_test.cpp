// Tracks and their bytes.
#include "pos/serve/track.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pos::serve {
namespace {

using ::testing::ElementsAre;

TrackRow rowAt(double t, double x, double y) {
  TrackRow row{.stamp = stampFromSeconds(t)};
  row[Column::X] = static_cast<float>(x);
  row[Column::Y] = static_cast<float>(y);
  return row;
}

Track ramp(int rows) {
  Track track;
  for (int i = 0; i < rows; ++i) track.append(rowAt(i, i, std::sin(0.1 * i)));
  return track;
}

template <class Value>
Value valueAt(const std::string& bytes, std::size_t offset) {
  Value value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

}  // namespace

TEST(Track, BytesAreLaidOutAsTheDocumentSays) {
  Track track;
  track.append(rowAt(1.5, 10, 20));
  track.append(rowAt(2.5, 11, 21));
  const std::string bytes = track.packed({.columns = {Column::Y, Column::X}});
  ASSERT_EQ(bytes.size(), 24 + 2 * 8 + 2 * 2 * 4);
  EXPECT_EQ(bytes.substr(0, 8), "POSTRK01");
  EXPECT_EQ(valueAt<std::uint32_t>(bytes, 8), 2U);
  EXPECT_EQ(valueAt<std::uint32_t>(bytes, 12), 2U);
  EXPECT_EQ(valueAt<std::uint32_t>(bytes, 16), 2U);
  EXPECT_EQ(valueAt<std::uint32_t>(bytes, 20), 0U);
  EXPECT_EQ(valueAt<double>(bytes, 24), 1.5);
  EXPECT_EQ(valueAt<double>(bytes, 32), 2.5);
  EXPECT_EQ(valueAt<float>(bytes, 40), 20.0F);
  EXPECT_EQ(valueAt<float>(bytes, 44), 21.0F);
  EXPECT_EQ(valueAt<float>(bytes, 48), 10.0F);
  EXPECT_EQ(valueAt<float>(bytes, 52), 11.0F);
  EXPECT_EQ(track.packed({}).size(), 24 + 2 * 8 + 2 * 4 * kColumns);
}

TEST(Track, AWindowBringsOneRowOnEitherSideAlong) {
  const Track track = ramp(100);
  const auto chosen = track.chosen({.from = stampFromSeconds(10), .to = stampFromSeconds(12)});
  EXPECT_THAT(chosen, ElementsAre(9U, 10U, 11U, 12U, 13U));
  EXPECT_EQ(track.chosen({}).size(), 100U);
  EXPECT_THAT(track.chosen({.to = stampFromSeconds(-5)}), ElementsAre(0U));
  EXPECT_THAT(track.chosen({.from = stampFromSeconds(500)}), ElementsAre(99U));
  EXPECT_LE(track.chosen({.from = stampFromSeconds(50), .to = stampFromSeconds(20)}).size(), 2U);
  EXPECT_TRUE(Track{}.chosen({}).empty());
}

TEST(Track, ThinningKeepsEndsAndExtremesAndTheBudget) {
  Track track;
  for (int i = 0; i < 10'000; ++i)
    track.append(rowAt(i, std::cos(0.001 * i), i == 6666 ? 50.0 : i == 3333 ? -50.0 : 0.0));
  for (const std::size_t points : {2UL, 3UL, 6UL, 50UL, 999UL}) {
    const auto chosen = track.chosen({.points = points});
    EXPECT_LE(chosen.size(), points);
    EXPECT_EQ(chosen.front(), 0U);
    EXPECT_EQ(chosen.back(), 9999U);
    EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
    if (points < 6) continue;
    EXPECT_NE(std::find(chosen.begin(), chosen.end(), 6666U), chosen.end()) << points;
    EXPECT_NE(std::find(chosen.begin(), chosen.end(), 3333U), chosen.end()) << points;
  }
}

TEST(Track, TheRowOfAMomentIsTheLastBeforeIt) {
  const Track track = ramp(10);
  EXPECT_FALSE(track.at(stampFromSeconds(-0.1)));
  EXPECT_EQ((*track.at(stampFromSeconds(3.9)))[Column::X], 3.0F);
  EXPECT_EQ((*track.at(stampFromSeconds(400)))[Column::X], 9.0F);
}

TEST(TrackRow, ErrorsAreSplitAlongTheTruth) {
  TrackRow row = rowAt(0, 3, 5);
  compare(row, Pose3::fromPlanar({0.0, 1.0, 0.7}), Eigen::Vector2d(0.0, 1.0));  // it drives to the north
  EXPECT_FLOAT_EQ(row[Column::Error], 5.0F);
  EXPECT_FLOAT_EQ(row[Column::ErrorAlong], 4.0F);
  EXPECT_FLOAT_EQ(row[Column::ErrorAcross], -3.0F);  // to the right
  TrackRow standing = rowAt(0, 3, 4);
  compare(standing, Pose3{}, std::nullopt);
  EXPECT_TRUE(std::isnan(standing[Column::ErrorAlong]));
}

TEST(TrackRow, TellsSigmasAndSpeedOfAnEstimate) {
  Matrix<3, 3> P = Matrix<3, 3>::Zero();
  P.diagonal() << 0.04, 0.09, 0.0001;
  P(0, 1) = P(1, 0) = 0.03;
  Estimate estimate = planarEstimate(stampFromSeconds(2), {1, 2, 0.5}, P);
  const TrackRow bare = rowOf(estimate);
  EXPECT_FLOAT_EQ(bare[Column::SigmaX], 0.2F);
  EXPECT_FLOAT_EQ(bare[Column::SigmaY], 0.3F);
  EXPECT_FLOAT_EQ(bare[Column::CorrXY], 0.5F);
  EXPECT_FLOAT_EQ(bare[Column::SigmaYaw], 0.01F);
  EXPECT_FLOAT_EQ(bare[Column::Yaw], 0.5F);
  EXPECT_TRUE(std::isnan(bare[Column::Speed]));
  estimate.twist.emplace().rates << -1.5, 0.0, 0.0;
  EXPECT_FLOAT_EQ(rowOf(estimate)[Column::Speed], -1.5F);
}

TEST(Columns, NamesAndNumbersAgree) {
  for (std::size_t i = 0; i < kColumns; ++i) EXPECT_EQ(columnOf(columnNames()[i]), static_cast<Column>(i));
  EXPECT_EQ(columnNames()[static_cast<std::size_t>(Column::Interval)], "interval");
  EXPECT_FALSE(columnOf("x"));
}

}  // namespace pos::serve
