#include "pos/map/coverage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pos/core/error.hpp"
#include "pos/map/plan_anchors.hpp"
#include "support/small_mine.hpp"

namespace pos::map {
namespace {

using test::networkOf;
using test::straightRoadway;

enum class Layout { OneWall, ZigZag, Pairs };

/// A straight roadway, 5 m wide, anchors 1 m under the tag; two spacings are looked at, far from its ends.
TunnelMap roadway5(Layout layout, double spacing) {
  TunnelMap map{.name = "5 m"};
  Roadway roadway = straightRoadway("R", {-10 * spacing, 0, 0}, {10 * spacing, 0, 0});
  roadway.width = 5.0;
  map.roadways = {roadway};
  for (int k = -10; k <= 10; ++k) {
    const double side = layout == Layout::ZigZag && k % 2 != 0 ? -2.5 : 2.5;
    map.anchors.push_back({.id = k, .p_map = {k * spacing, side, 0.5}});
    if (layout == Layout::Pairs) map.anchors.push_back({.id = 100 + k, .p_map = {k * spacing, -2.5, 0.5}});
  }
  return map;
}

CoverageSummary middle(Layout layout, double spacing, double range) {
  const Network network = networkOf(roadway5(layout, spacing));
  std::vector<CoverageSample> samples;
  for (const CoverageSample& sample : coverage(network, {.range_limit = range, .singular_sigma = 1e5})) {
    if (sample.p_map.x() > -spacing && sample.p_map.x() < spacing) samples.push_back(sample);
  }
  return summary(samples);
}

struct Row {
  Layout layout;
  double spacing;
  double range;
  double along;
  double across;
  double across_p90;
};

}  // namespace

/// The table of bounds for a 5 m roadway that the project started from, computed by an independent program.
/// Two figures are printed there with two digits; each has to agree within 10 %, or half its last digit.
TEST(Coverage, BoundsAgreeWithTheTableOfLayouts) {
  for (const Row& row :
       {Row{Layout::OneWall, 50, 60, 0.07, 0.54, 0.70}, Row{Layout::ZigZag, 50, 60, 0.16, 1.07, 7.0},
        Row{Layout::Pairs, 50, 60, 0.05, 0.34, 0.50}, Row{Layout::OneWall, 50, 120, 0.05, 0.50, 0.67},
        Row{Layout::ZigZag, 50, 120, 0.05, 0.52, 0.74}, Row{Layout::Pairs, 50, 120, 0.03, 0.33, 0.47},
        Row{Layout::OneWall, 100, 120, 0.07, 1.06, 1.4}, Row{Layout::ZigZag, 100, 120, 0.16, 2.1, 14.0},
        Row{Layout::Pairs, 100, 120, 0.05, 0.67, 0.99}, Row{Layout::OneWall, 200, 250, 0.07, 2.1, 2.8},
        Row{Layout::ZigZag, 200, 250, 0.16, 4.3, 28.0}, Row{Layout::Pairs, 200, 250, 0.05, 1.3, 2.0},
        Row{Layout::OneWall, 400, 450, 0.07, 4.2, 5.6}, Row{Layout::ZigZag, 400, 450, 0.16, 8.5, 56.0},
        Row{Layout::Pairs, 400, 450, 0.05, 2.7, 3.9}}) {
    const CoverageSummary s = middle(row.layout, row.spacing, row.range);
    const std::string name = std::to_string(static_cast<int>(row.layout)) + " " + std::to_string(row.spacing);
    EXPECT_NEAR(s.along_median, row.along, std::max(0.1 * row.along, 0.005)) << name;
    EXPECT_NEAR(s.across_median, row.across, 0.1 * row.across) << name;
    // The zig-zag's p90 lies on the steep flank of its singular spot and moves with the sampling.
    const double share = row.layout == Layout::ZigZag ? 0.15 : 0.1;
    EXPECT_NEAR(s.across_p90, row.across_p90, share * row.across_p90) << name;
  }
}

TEST(Coverage, TwoAnchorsOnALineThroughTheTagAreSingular) {
  const std::vector<Anchor> anchors = {{.id = 1, .p_map = {-20, 2.5, 0}}, {.id = 2, .p_map = {20, -2.5, 0}}};
  const CoverageSample on_line = bound({0, 0, 1}, 0.0, anchors, {});
  EXPECT_EQ(on_line.anchors, 2);
  EXPECT_FALSE(on_line.along.has_value());
  EXPECT_FALSE(on_line.across.has_value());
  EXPECT_TRUE(bound({5, 1, 1}, 0.0, anchors, {}).across.has_value());
  EXPECT_FALSE(bound({5, 1, 1}, 0.0, {}, {}).along.has_value());
}

/// Closed form: two anchors at right angles, in the plane of the tag, along and across.
TEST(Coverage, RightAnglesGiveTheRangeSigmaItself) {
  const std::vector<Anchor> anchors = {{.id = 1, .p_map = {30, 0, 1}}, {.id = 2, .p_map = {0, 4, 1}}};
  const CoverageSample sample = bound({0, 0, 1}, 0.0, anchors, {.range_sigma = 0.2});
  EXPECT_NEAR(*sample.along, 0.2, 1e-12);
  EXPECT_NEAR(*sample.across, 0.2, 1e-12);
  const CoverageSample surveyed = bound(
      {0, 0, 1}, 0.0, {{.id = 1, .p_map = {30, 0, 1}, .survey_sigma = 0.15}, {.id = 2, .p_map = {0, 4, 1}}},
      {.range_sigma = 0.2});
  EXPECT_NEAR(*surveyed.along, 0.25, 1e-12) << "the survey of the anchor along the roadway counts";
  EXPECT_NEAR(*surveyed.across, 0.2, 1e-12);
}

/// A bound is a bound: least squares from noisy ranges scatters just so.
TEST(Coverage, LeastSquaresScattersAsTheBoundSays) {
  const std::vector<Anchor> anchors = {
      {.id = 1, .p_map = {-30, 2.5, 2}}, {.id = 2, .p_map = {15, 2.5, 2}}, {.id = 3, .p_map = {40, -2.5, 2}}};
  const Eigen::Vector3d truth(0.0, 0.3, 1.0);
  const double heading = 0.4;
  const CoverageSample expected = bound(truth, heading, anchors, {.range_sigma = 0.01});
  RandomStream random(1, 0);
  double along = 0.0;
  double across = 0.0;
  constexpr int kRuns = 4000;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> ranges;
    for (const Anchor& anchor : anchors)
      ranges.push_back((truth - anchor.p_map).norm() + random.normal(0.0, 0.01));
    Eigen::Vector3d p = truth;
    for (int iteration = 0; iteration < 5; ++iteration) {
      Eigen::Matrix2d N = Eigen::Matrix2d::Zero();
      Eigen::Vector2d b = Eigen::Vector2d::Zero();
      for (std::size_t i = 0; i < anchors.size(); ++i) {
        const Eigen::Vector3d d = p - anchors[i].p_map;
        const Eigen::Vector2d h = d.head<2>() / d.norm();
        N += h * h.transpose();
        b += h * (ranges[i] - d.norm());
      }
      p.head<2>() += N.ldlt().solve(b);
    }
    const Eigen::Vector2d e = (p - truth).head<2>();
    along += std::pow(std::cos(heading) * e.x() + std::sin(heading) * e.y(), 2);
    across += std::pow(-std::sin(heading) * e.x() + std::cos(heading) * e.y(), 2);
  }
  // A variance from n samples scatters by sqrt(2 / n); four of that.
  const double four_sigma = 4.0 * std::sqrt(2.0 / kRuns);
  EXPECT_NEAR(along / kRuns / (*expected.along * *expected.along), 1.0, four_sigma);
  EXPECT_NEAR(across / kRuns / (*expected.across * *expected.across), 1.0, four_sigma);
}

TEST(Coverage, SamplesAreTheMiddlesOfEveryMetre) {
  const Network network = networkOf(roadway5(Layout::OneWall, 50));
  const auto samples = coverage(network, 0, {});
  ASSERT_EQ(samples.size(), 1000U);
  EXPECT_NEAR(samples[0].point.chainage, 0.5, 1e-9);
  EXPECT_NEAR(samples[999].point.chainage, 999.5, 1e-9);
  EXPECT_NEAR(samples[0].p_map.z(), 1.5, 1e-12);
}

TEST(Coverage, SummaryCountsSingularSamplesAsInfinite) {
  const CoverageSummary s = summary({{.anchors = 2, .along = 0.1, .across = 1.0}, {.anchors = 0}});
  EXPECT_EQ(s.singular, 1U);
  EXPECT_EQ(s.anchors_min, 0);
  EXPECT_TRUE(std::isinf(s.across_max));
  EXPECT_EQ(summary({}).samples, 0U);
}

TEST(Coverage, BadRulesAreRefused) {
  EXPECT_THROW(validated(CoverageRules{.range_sigma = 0.0}), ConfigError);
  EXPECT_THROW(validated(CoverageRules{.step = -1.0}), ConfigError);
}

namespace {

PlanRules cheapPlan() {
  return {.along = 0.15, .across = 0.8, .met_share = 1.0, .coverage = {.range_limit = 80.0, .step = 5.0}};
}

Network emptyRoadway(double length) {
  TunnelMap map{.name = "empty"};
  map.roadways = {straightRoadway("R", {0, 0, 0}, {length, 0, 0})};
  map.roadways[0].width = 5.0;
  return networkOf(map);
}

std::size_t metBy(const Network& network, const std::vector<Anchor>& anchors, const PlanRules& rules) {
  TunnelMap map = network.map();
  map.anchors = anchors;
  std::size_t met = 0;
  for (const CoverageSample& s : coverage(networkOf(map), rules.coverage))
    met += s.along && s.across && *s.along <= rules.along && *s.across <= rules.across ? 1 : 0;
  return met;
}

}  // namespace

TEST(PlanAnchors, PlanMeetsItsTargetByTheCoverageItself) {
  const Network network = emptyRoadway(300.0);
  const AnchorPlan plan = plannedAnchors(network, cheapPlan());
  EXPECT_TRUE(plan.met);
  EXPECT_EQ(metBy(network, plan.added, cheapPlan()), plan.samples);
  EXPECT_NEAR(plan.roadway_length, 300.0, 1e-9);
  EXPECT_NEAR(plan.anchorsPerKilometre(), static_cast<double>(plan.added.size()) / 0.3, 1e-9);
}

TEST(PlanAnchors, NoAnchorOfThePlanCanBeLeftOut) {
  const Network network = emptyRoadway(300.0);
  const AnchorPlan plan = plannedAnchors(network, cheapPlan());
  for (std::size_t i = 0; i < plan.added.size(); ++i) {
    std::vector<Anchor> fewer = plan.added;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_LT(metBy(network, fewer, cheapPlan()), plan.samples) << "anchor " << plan.added[i].id;
  }
}

/// Exhaustion on a roadway so short that all choices can be tried: greedy may cost one anchor more.
TEST(PlanAnchors, IsWithinOneAnchorOfTheBestChoice) {
  const Network network = emptyRoadway(40.0);
  PlanRules rules = cheapPlan();
  const AnchorPlan plan = plannedAnchors(network, rules);
  std::vector<Anchor> places;
  for (int i = 0; i <= 4; ++i) {
    for (const double side : {2.5, -2.5})
      places.push_back({.id = 10 * i + (side > 0), .p_map = {10.0 * i, side, 2.0}});
  }
  std::size_t best = places.size();
  for (unsigned choice = 1; choice < (1U << places.size()); ++choice) {
    std::vector<Anchor> chosen;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if ((choice >> i & 1U) != 0) chosen.push_back(places[i]);
    }
    if (chosen.size() < best && metBy(network, chosen, rules) == plan.samples) best = chosen.size();
  }
  EXPECT_LE(plan.added.size(), best + 1);
}

TEST(PlanAnchors, HarderTargetCostsMoreAndAnImpossibleOneSaysSo) {
  const Network network = emptyRoadway(200.0);
  PlanRules hard = cheapPlan();
  hard.across = 0.4;
  EXPECT_GT(plannedAnchors(network, hard).added.size(), plannedAnchors(network, cheapPlan()).added.size());
  hard.across = 1e-4;
  EXPECT_FALSE(plannedAnchors(network, hard).met);
}

TEST(PlanAnchors, AnchorsAlreadyThereAreUsed) {
  const Network network = emptyRoadway(200.0);
  const AnchorPlan fresh = plannedAnchors(network, cheapPlan());
  TunnelMap map = network.map();
  map.anchors = fresh.added;
  const AnchorPlan again = plannedAnchors(networkOf(map), cheapPlan());
  EXPECT_TRUE(again.met);
  EXPECT_TRUE(again.added.empty());
}

TEST(Coverage, AMapWithoutRoadwaysHasNoCoverageToTell) {
  TunnelMap map{.name = "anchors only"};
  map.anchors = {{.id = 1, .p_map = {0, 0, 2}}, {.id = 2, .p_map = {10, 0, 2}}};
  EXPECT_THROW((void)coverage(networkOf(map), {}), ConfigError);
  EXPECT_THROW((void)plannedAnchors(networkOf(map), {}), ConfigError);
}

TEST(PlanAnchors, BadRulesAreRefused) {
  EXPECT_THROW(validated(PlanRules{.along = 0.0}), ConfigError);
  EXPECT_THROW(validated(PlanRules{.met_share = 1.5}), ConfigError);
}

}  // namespace pos::map
