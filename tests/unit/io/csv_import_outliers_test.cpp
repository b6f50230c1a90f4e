// Outliers that an import adds on purpose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/error.hpp"
#include "pos/io/csv_import.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<Measurement> manyRanges(std::size_t count, double range) {
  BeaconRange reading;
  reading.range = range;
  return {count, Measurement{Stamp{}, "uwb", reading}};
}

TEST(CsvImport, OutliersComeWithBothSignsInTheAskedShare) {
  const ImportOptions options{
      .range_outlier_probability = 0.2, .range_outlier_min_m = 2.0, .range_outlier_max_m = 5.0, .seed = 3};
  constexpr std::size_t kCount = 10000;
  const auto [measurements, count] = withRangeOutliers(manyRanges(kCount, 10.0), options);
  std::size_t longer = 0;
  std::size_t shorter = 0;
  for (const Measurement& m : measurements) {
    const double error = std::get<BeaconRange>(m.reading).range - 10.0;
    if (error == 0.0) continue;
    EXPECT_GE(std::abs(error), 2.0);
    EXPECT_LE(std::abs(error), 5.0);
    ++(error > 0.0 ? longer : shorter);
  }
  EXPECT_EQ(longer + shorter, count);
  // binomial: 4 sigma on each side
  EXPECT_NEAR(static_cast<double>(count), 2000.0, 4.0 * 40.0);
  EXPECT_NEAR(static_cast<double>(longer), static_cast<double>(shorter), 4.0 * 45.0);
}

TEST(CsvImport, OutliersLeaveAtLeastFiveCentimetres) {
  const ImportOptions options{
      .range_outlier_probability = 1.0, .range_outlier_min_m = 5.0, .range_outlier_max_m = 6.0};
  const auto [measurements, count] = withRangeOutliers(manyRanges(100, 1.0), options);
  for (const Measurement& m : measurements) {
    const double range = std::get<BeaconRange>(m.reading).range;
    EXPECT_TRUE(range == 0.05 || range >= 6.0) << range;
  }
  EXPECT_EQ(count, 100U);
}

TEST(CsvImport, OutliersRepeatWithTheSeedAndDifferWithAnother) {
  const auto rangesWith = [](std::uint64_t seed) {
    std::vector<double> ranges;
    const ImportOptions options{.range_outlier_probability = 0.5, .seed = seed};
    for (const Measurement& m : withRangeOutliers(manyRanges(50, 20.0), options).measurements) {
      ranges.push_back(std::get<BeaconRange>(m.reading).range);
    }
    return ranges;
  };
  EXPECT_EQ(rangesWith(1), rangesWith(1));
  EXPECT_NE(rangesWith(1), rangesWith(2));
}

TEST(CsvImport, OptionsOutOfRangeAreRefused) {
  EXPECT_THAT(complaintOf<ConfigError>([] { validated(ImportOptions{.range_outlier_probability = 1.5}); }),
              AllOf(HasSubstr("range_outlier_probability"), HasSubstr("1.5"), HasSubstr("0 .. 1")));
  EXPECT_THROW(validated(ImportOptions{.range_outlier_probability = std::nan("")}), ConfigError);
  EXPECT_THROW(validated(ImportOptions{.range_outlier_min_m = 5.0, .range_outlier_max_m = 4.0}), ConfigError);
}

}  // namespace
}  // namespace pos::io
