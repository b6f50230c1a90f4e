#include "pos/report/time_distance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <regex>

#include "pos/report/html.hpp"
#include "pos/report/locks_html.hpp"

namespace pos::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TimeDistance diagram() {
  TimeDistance d;
  d.name = "time_distance";
  d.title = "Time and distance along route <1>";
  d.caption = "how to read it";
  d.distance_label = "distance along route 1 (m)";
  d.t1 = 100.0;
  d.to = 200.0;
  d.bands = {{"i_1", 0.0, 100.0}, {"i_2", 100.0, 200.0}, {"j_0", 80.0, 140.0}};
  d.bars = {{10.0, 40.0, 0.0, 50.0, 0}, {50.0, 90.0, 100.0, 200.0, 1}};
  d.bar_names = {{"locked in the direction of the axis", 0}};
  d.lines = {{.label = "7",
              .classes = "vehicle",
              .legend = false,
              .t = {10.0, 20.0, 30.0, 40.0},
              .distance = {0.0, 20.0, std::numeric_limits<double>::quiet_NaN(), 60.0}}};
  return d;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// One road of 200 m with a boundary in its middle, driven at 2 m/s.
eval::RunSummary drive() {
  auto mine = std::make_shared<map::TunnelMap>();
  mine->name = "test";
  map::Roadway main{.id = "main", .width = 5.0, .lanes = 1};
  main.centreline = {{{0.0, 0.0, 0.0}}, {{200.0, 0.0, 0.0}}};
  mine->roadways = {main};
  map::Chamber chamber;
  chamber.id = "C";
  chamber.place = {"main", 100.0};
  chamber.length = 10.0;
  chamber.depth = 3.0;
  mine->chambers = {chamber};
  const map::Network network(mine);
  const map::RoadGraph graph(network);
  eval::RunSummary run;
  run.run = "drive";
  run.interval_scene = std::make_shared<const eval::IntervalScene>(
      eval::IntervalScene{network, map::divided(graph, network, map::DivisionRules{})});
  run.start = stampFromSeconds(1000.0);
  run.end = stampFromSeconds(1090.0);
  eval::EstimatorSummary estimator;
  estimator.name = "ekf";
  estimator.intervals.emplace();
  for (int k = 0; k <= 90; ++k) {
    estimator.intervals->record.samples.push_back({.stamp = stampFromSeconds(1000.0 + k),
                                                   .matched = true,
                                                   .point = {0, 10.0 + 2.0 * k},
                                                   .along_sigma = 1.0});
    run.truth_path.push_back({static_cast<double>(k), 10.0 + 2.0 * k, 0.0, std::nullopt});
  }
  estimator.intervals->record.visits = {{0, stampFromSeconds(1000.0), 0.1, stampFromSeconds(1045.0)},
                                        {1, stampFromSeconds(1045.0), 0.1, std::nullopt}};
  estimator.intervals->judged = 100;
  estimator.intervals->right = 99;
  run.estimators.push_back(std::move(estimator));
  return run;
}

}  // namespace

TEST(TimeDistanceFigure, ShowsTitleUnitsBandsBarsAndLines) {
  const NamedFigure figure = timeDistanceFigure(diagram());
  EXPECT_THAT(figure.svg, HasSubstr("Time and distance along route &lt;1&gt;"));
  EXPECT_THAT(figure.svg, HasSubstr("time since the start (s)"));
  EXPECT_THAT(figure.svg, HasSubstr("distance along route 1 (m)"));
  for (const char* label : {">i_1<", ">i_2<", ">j_0<", ">7<", "lock intervals"})
    EXPECT_THAT(figure.svg, HasSubstr(label));
  EXPECT_EQ(count(figure.svg, " lock s"), 2u);  // bars
  EXPECT_THAT(figure.svg, Not(HasSubstr("nan")));
  EXPECT_EQ(figure.svg, timeDistanceFigure(diagram()).svg);
}

TEST(TimeDistanceFigure, ALineIsBrokenWhereTheVehicleIsOffTheRoad) {
  TimeDistance whole = diagram();
  whole.lines[0].distance[2] = 40.0;
  const auto lines = [](const TimeDistance& d) { return count(timeDistanceFigure(d).svg, "<polyline"); };
  EXPECT_EQ(lines(diagram()) + count(timeDistanceFigure(diagram()).svg, "<circle"),
            lines(whole) + count(timeDistanceFigure(whole).svg, "<circle") + 1);
}

TEST(TimeDistance, OneRoadIsDrawnByItsChainage) {
  const auto d = timeDistance(drive());
  ASSERT_TRUE(d);
  EXPECT_EQ(d->distance_label, "chainage of main (m)");
  EXPECT_NEAR(d->from, 10.0, 1e-9);
  EXPECT_NEAR(d->to, 190.0, 1e-9);
  ASSERT_EQ(d->lines.size(), 2u);  // truth and estimator
  EXPECT_EQ(d->lines[1].label, "ekf");
  EXPECT_NEAR(d->lines[1].distance.at(45), 100.0, 1e-9);
  ASSERT_EQ(d->bars.size(), 2u);
  EXPECT_NEAR(d->bars[0].end, 45.0, 1e-9);
  EXPECT_NEAR(d->bars[0].to, 100.0, 1e-9);
  EXPECT_NEAR(d->bars[1].end, 90.0, 1e-9);  // still occupied at the end of the run
  EXPECT_EQ(d->bands.size(), 2u);
}

TEST(TimeDistance, NothingWithoutIntervals) {
  EXPECT_FALSE(timeDistance(eval::RunSummary{}));
}

TEST(ReportHtml, HasASectionOnIntervalsWhereTheyWereEvaluated) {
  const std::string html = reportHtml(drive(), "");
  EXPECT_THAT(html, HasSubstr("Lock intervals"));
  EXPECT_THAT(html, HasSubstr("99.0 %"));
  EXPECT_THAT(html, HasSubstr("figure id=\"time_distance\""));
  eval::RunSummary without = drive();
  without.interval_scene.reset();
  without.estimators[0].intervals.reset();
  EXPECT_THAT(reportHtml(without, ""), Not(HasSubstr("Lock intervals")));
}

TEST(LocksHtml, HasFiguresFindingsAndTheDiagram) {
  const std::string html = locksHtml(
      {"night shift", "mine", {{"requests", "1 000"}}, {"vehicle 3: releases <early>"}, diagram()}, "a: 1");
  for (const char* part :
       {"night shift", "requests", "1 000", "releases &lt;early&gt;", "time_distance", "a: 1"})
    EXPECT_THAT(html, HasSubstr(part));
}

}  // namespace pos::report
