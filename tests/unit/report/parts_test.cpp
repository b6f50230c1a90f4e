#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "pos/report/axes.hpp"
#include "pos/report/comparison.hpp"
#include "pos/report/png.hpp"
#include "pos/report/text.hpp"
#include "unit/report/demo_run.hpp"

namespace pos::report {

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST(Text, ShowsThreeDigitsThatCount) {
  EXPECT_EQ(rounded(0.41234), "0.412");
  EXPECT_EQ(rounded(4.1234), "4.12");
  EXPECT_EQ(rounded(9.996), "10.0");
  EXPECT_EQ(rounded(99.96), "100");
  EXPECT_EQ(rounded(41234.5), "41234");
  EXPECT_EQ(rounded(-0.0001), "0.000");
  EXPECT_EQ(rounded(std::nan("")), kNoValue);
  EXPECT_EQ(fixed(std::numeric_limits<double>::infinity(), 2), kNoValue);
}

TEST(Text, NeverRoundsUpToAll) {
  EXPECT_EQ(percent(1.0), "100.0 %");
  EXPECT_EQ(percent(0.99999), "> 99.9 %");
  EXPECT_EQ(percent(0.9541), "95.4 %");
}

TEST(Text, WritesMomentsAndLengths) {
  EXPECT_EQ(momentText(stampFromSeconds(1.7e9)), "2023-11-14 22:13:20 UTC");
  EXPECT_EQ(momentText(stampFromSeconds(12.5)), "12.5 s");
  EXPECT_EQ(durationText(durationFromSeconds(1925.0)), "32 min 5 s");
  EXPECT_EQ(durationText(durationFromSeconds(3720.0)), "1 h 2 min");
  EXPECT_EQ(grouped(1234567), "1 234 567");
  EXPECT_EQ(grouped(12), "12");
}

TEST(Text, EscapesAndShortensWithoutBreakingCharacters) {
  EXPECT_EQ(escaped("<a href=\"x\">&\x01</a>"), "&lt;a href=&quot;x&quot;&gt;&amp;&lt;/a&gt;");
  EXPECT_EQ(shortened("Stre\u00dfe Nord", 6), "Stre\u00df\u2026");
  EXPECT_EQ(shortened("short", 5), "short");
  EXPECT_EQ(characterCount("Stra\u00dfe"), 6U);
}

TEST(Axes, TicksAreRoundAndInside) {
  EXPECT_THAT(niceTicks(0.0, 10.0, 5), ElementsAre(0.0, 2.0, 4.0, 6.0, 8.0, 10.0));
  EXPECT_EQ(plotOver({0, 0, 100, 50}, 0.0, 1.0, -1.9, 1.9).y.ticks(2).size(), 3U);  // never zero alone
  EXPECT_TRUE(niceTicks(1.0, 1.0, 5).empty());
  EXPECT_THAT(logPlotOver({0, 0, 100, 50}, 0.0, 1.0, 0.05, 3.0).y.ticks(6),
              ElementsAre(0.05, 0.1, 0.2, 0.5, 1.0, 2.0));
  EXPECT_THAT(logPlotOver({0, 0, 100, 50}, 0.0, 1.0, 0.01, 1e5).y.ticks(2),
              ElementsAre(0.01, 1.0, 100.0, 1e4));
  const auto decades = logTicks(0.01, 100.0);
  ASSERT_EQ(decades.size(), 5U);
  EXPECT_NEAR(decades.front(), 0.01, 1e-12);
}

TEST(Axes, ScalesMapEndsToEnds) {
  const Plot plot = logPlotOver({10.0, 20.0, 100.0, 50.0}, 0.0, 4.0, 0.1, 10.0);
  EXPECT_NEAR(plot.x(2.0), 60.0, 1e-9);
  EXPECT_NEAR(plot.y(1.0), 45.0, 1e-9);
  EXPECT_NEAR(plot.y(0.0), 70.0, 1e-9);  // zero is drawn at the lower end
  EXPECT_NEAR(plot.y(10.0), 20.0, 1e-9);
}

TEST(Axes, RangesWithoutWidthAreWidened) {
  const Plot plot = plotOver({0.0, 0.0, 100.0, 50.0}, 3.0, 3.0, 0.0, 0.0);
  EXPECT_NEAR(plot.x(3.0), 50.0, 1e-9);
  EXPECT_NEAR(plot.y(0.0), 25.0, 1e-9);
}

TEST(Png, Base64AgreesWithTheStandardsExamples) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(Png, HasHeaderSizeAndKnownChecksum) {
  const std::string png = pngBytes({3, 2, {0, 1, 2, 3, 0, 2}});
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png.substr(12, 4), "IHDR");
  EXPECT_EQ(png[19], 3);
  EXPECT_EQ(png[23], 2);
  EXPECT_EQ(png.substr(png.size() - 8), std::string("IEND\xae\x42\x60\x82", 8));
}

TEST(Png, GridPictureIsTurnedUprightAndThinned) {
  map::OccupancyGrid grid;
  grid.columns = 4;
  grid.rows = 2;
  grid.occupancy = {0, 0, 0, 100, 255, 255, 50, 50};  // lower row first
  const GridPicture whole = gridPicture(grid);
  EXPECT_THAT(whole.picture.pixels, ElementsAre(3, 3, 1, 1, 0, 0, 0, 2));
  const GridPicture thin = gridPicture(grid, 2);
  EXPECT_EQ(thin.step, 2);
  EXPECT_THAT(thin.picture.pixels, ElementsAre(0, 2));  // rock wins
}

TEST(Comparison, MarksTheBestOfAColumnButNotWhereAllAreEqual) {
  const Comparison table = comparison(demoRun());
  ASSERT_EQ(table.rows.size(), 4U);
  const auto column = [&table](const std::string& title) {
    return static_cast<std::size_t>(std::find(table.columns.begin(), table.columns.end(), title) -
                                    table.columns.begin());
  };
  EXPECT_TRUE(table.rows[0][column("xy rmse m")].best);
  EXPECT_FALSE(table.rows[1][column("xy rmse m")].best);
  EXPECT_TRUE(table.rows[0][column("NEES xy [95 %]")].best);
  EXPECT_TRUE(table.rows[3][column("us/meas")].best);
  for (const auto& row : table.rows) EXPECT_FALSE(row[column("coverage")].best);
}

TEST(Comparison, TextTableIsAligned) {
  const std::vector<std::string> lines = linesOf(comparisonTable(demoRun()));
  ASSERT_EQ(lines.size(), 7U);
  for (std::size_t i = 1; i < 6; ++i)
    EXPECT_EQ(characterCount(lines[i]), characterCount(lines[0])) << lines[i];
  EXPECT_THAT(lines[2], HasSubstr("range_odometry"));
  EXPECT_THAT(lines[2], HasSubstr("*0."));
}

TEST(Comparison, WarnsInPlainWords) {
  const std::vector<std::string> all = warnings(demoRun());
  EXPECT_THAT(all,
              testing::Contains(HasSubstr("damaged: reading ended at byte 1 234 567 after 18 000 objects")));
  EXPECT_THAT(all, testing::Contains(HasSubstr("mcl is too sure of itself by a factor ~2.")));
  EXPECT_THAT(all, testing::Not(testing::Contains(HasSubstr("range_odometry"))));
}

TEST(Comparison, SaysWhatAnImperfectTruthWouldExplainUntilItIsCounted) {
  eval::RunSummary run = demoRun();
  EXPECT_THAT(warnings(run),
              testing::Contains(testing::ContainsRegex("truth was taken as perfect.*mcl 0\\.2[0-9] m")));
  EXPECT_THAT(comparisonTable(run), testing::Not(HasSubstr("NEES counts the truth")));
  for (eval::EstimatorSummary& estimator : run.estimators)
    estimator.evaluation->consistency.truth_sigma = 0.1;
  EXPECT_THAT(warnings(run), testing::Not(testing::Contains(HasSubstr("truth was taken as perfect"))));
  EXPECT_THAT(comparisonTable(run), HasSubstr("NEES counts the truth as good to 0.100 m per axis"));
}

TEST(Comparison, WarnsBelowNinetyFivePercentCoverage) {
  eval::RunSummary run = demoRun();
  run.estimators[0].evaluation->association.coverage = 0.949;
  EXPECT_THAT(warnings(run), testing::Contains(HasSubstr("range_odometry covers only 94.9 %")));
}

}  // namespace pos::report
