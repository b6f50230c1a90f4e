#include "pos/lidar/legs.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "leg_scene.hpp"
#include "pos/core/error.hpp"

namespace pos::lidar {
namespace {

using scene::Cut;
using scene::legAt;
using scene::rowSweeps;
using scene::scanner;

int judged(const LegCounts& counts) {
  return counts.few_points + counts.outside + counts.bad_width + counts.bad_arc + counts.off_row +
         counts.bad_fit;
}

/// The support whose true place is nearest to a detection.
int supportOf(const LegDetection& leg, double station) {
  return static_cast<int>(std::lround((leg.centre.x() + station + 15.0) / 1.5));
}

Scan2D scanOf(std::vector<float> ranges) {
  Scan2D scan{.angle_step = kPi / 720.0, .range_max = 15.0, .ranges = std::move(ranges)};
  scan.valid.assign(scan.ranges.size(), 1);
  return scan;
}

/// A scan with one upright plate of `width`, `lateral` to the left, its middle `along` ahead.
Scan2D plate(double along, double lateral, double width) {
  std::vector<float> ranges;
  for (int i = 0; i < 721; ++i) {
    const double angle = i * kPi / 720.0;
    const double x = lateral / std::tan(angle);
    ranges.push_back(std::abs(x - along) < 0.5 * width ? static_cast<float>(lateral / std::sin(angle))
                                                       : 0.0F);
  }
  return scanOf(ranges);
}

}  // namespace

TEST(LegFinder, FindsEveryLegWithinReachWhereItStands) {
  LegFinder finder({});
  for (const double station : {100.0, 100.4, 101.1}) {
    const auto scans = rowSweeps(scanner(), Cut{station, 0.0, 0.0});
    const LegSweep sweep = finder.find(scans.at(0));
    EXPECT_EQ(sweep.view, LegView::Legs);
    std::set<int> found;
    for (const LegDetection& leg : sweep.legs) {
      const int support = supportOf(leg, station);
      found.insert(support);
      EXPECT_LT((leg.centre - legAt(support, station)).norm(), 0.025) << support;
      EXPECT_GE(leg.points, 4);
    }
    EXPECT_EQ(found.size(), sweep.legs.size());
    for (int support = 0; support < 254; ++support) {
      const Eigen::Vector2d leg = legAt(support, station);
      if (std::abs(leg.x()) > 10.0) continue;
      EXPECT_EQ(found.count(support), 1U) << support;
    }
    EXPECT_EQ(sweep.counts.clusters, judged(sweep.counts) + static_cast<int>(sweep.legs.size()));
    EXPECT_EQ(sweep.counts.beams, 721);
  }
}

// 500 sweeps, each of a new place: errors in units of their covariance are chi-square with 2 degrees of
// freedom, mean 2. Their mean over 6000 legs scatters by 2 / sqrt(6000) = 0.026; upright legs, so that there
// is no bias of the tilt.
TEST(LegFinder, CovarianceIsHonestInFullSweeps) {
  sim::LegConfig config = scanner();
  config.row.tilt = 0.0;
  LegFinder finder({});
  double sum = 0.0;
  int count = 0;
  const auto scans = rowSweeps(config, Cut{100.0, 0.3, 20.0 - 0.04});
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const double station = 100.0 + 0.3 * 0.04 * static_cast<double>(i);
    for (const LegDetection& leg : finder.find(scans[i]).legs) {
      const Eigen::Vector2d error = leg.centre - legAt(supportOf(leg, station), station);
      if (std::abs(leg.centre.x()) > 10.0) continue;
      sum += error.dot(leg.covariance.llt().solve(error));
      ++count;
    }
  }
  EXPECT_GT(count, 6000);
  EXPECT_NEAR(sum / count, 2.0, 0.15);
}

// The axis of a leaning leg meets the scan plane where the cut's centre is, whatever the circle says.
TEST(LegFinder, KnownTiltTakesTheBiasOut) {
  const sim::LegConfig config = scanner(0.0, 0.0);
  LegFinder plain({});
  LegFinder leaning({.tilt = config.row.tilt});
  const auto scans = rowSweeps(config, Cut{100.0, 0.3, 2.0});
  double plain_worst = 0.0;
  double leaning_worst = 0.0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const double station = 100.0 + 0.3 * 0.04 * static_cast<double>(i);
    for (const LegDetection& leg : plain.find(scans[i]).legs) {
      plain_worst = std::max(plain_worst, (leg.centre - legAt(supportOf(leg, station), station)).norm());
    }
    for (const LegDetection& leg : leaning.find(scans[i]).legs) {
      leaning_worst = std::max(leaning_worst, (leg.centre - legAt(supportOf(leg, station), station)).norm());
    }
  }
  EXPECT_GT(plain_worst, 1.5e-3);
  EXPECT_LT(plain_worst, 3e-3);
  EXPECT_LT(leaning_worst, 1e-5);
}

TEST(LegFinder, CalibrationTakesTheScannersErrorsOut) {
  sim::LegConfig config = scanner(0.0, 0.0);
  config.row.tilt = 0.0;
  config.scanner.errors = sim::LidarErrors::paper();
  const auto scans = rowSweeps(config, Cut{100.0, 0.0, 0.0});
  LegFinder raw({});
  LegFinder calibrated({.calibration = ScannerCalibration::paper()});
  double raw_worst = 0.0;
  for (const LegDetection& leg : raw.find(scans.at(0)).legs) {
    raw_worst = std::max(raw_worst, (leg.centre - legAt(supportOf(leg, 100.0), 100.0)).norm());
  }
  EXPECT_GT(raw_worst, 0.03);
  const LegSweep sweep = calibrated.find(scans.at(0));
  EXPECT_GE(sweep.legs.size(), 15U);
  for (const LegDetection& leg : sweep.legs) {
    EXPECT_LT((leg.centre - legAt(supportOf(leg, 100.0), 100.0)).norm(), 1e-5);
  }
}

TEST(LegFinder, PartOfTheFaceIsSearchedAsIfItWereAll) {
  const auto scans = rowSweeps(scanner(), Cut{100.0, 0.0, 0.0});
  LegFinder finder({});
  const LegSweep all = finder.find(scans.at(0));
  std::vector<Eigen::Vector2d> ahead;
  for (const LegDetection& leg : all.legs) {
    if (leg.centre.x() > 6.0 && leg.centre.x() < 10.5) ahead.push_back(leg.centre);
  }
  const LegSweep part = finder.find(scans.at(0), {.from = 6.0, .to = 10.3});
  ASSERT_EQ(part.legs.size(), ahead.size());
  EXPECT_EQ(part.legs.size(), 3U);
  for (std::size_t i = 0; i < ahead.size(); ++i) EXPECT_EQ(part.legs[i].centre, ahead[i]);
  EXPECT_GE(part.counts.outside, 12);
  EXPECT_EQ(part.counts.clusters, judged(part.counts) + 3);
}

TEST(LegFinder, LegsAreToldApartWhereTheirRangesAreEqual) {
  // Half way between two supports the next two are equally far, so that only the gap of beams parts them.
  const auto scans = rowSweeps(scanner(0.0, 0.0), Cut{100.0 + 0.25, 0.0, 0.0});
  LegFinder finder({});
  std::set<int> found;
  for (const LegDetection& leg : finder.find(scans.at(0)).legs) found.insert(supportOf(leg, 100.25));
  EXPECT_EQ(found.count(76) + found.count(77), 2U);
}

TEST(LegFinder, PlatesPostsAndOtherRowsAreNoLegs) {
  LegFinder finder({});
  const LegSweep wide = finder.find(plate(3.0, 4.0, 0.8));
  EXPECT_TRUE(wide.legs.empty());
  EXPECT_EQ(wide.counts.bad_width, 1);
  EXPECT_EQ(wide.view, LegView::NoLegs);
  const LegSweep flat = finder.find(plate(0.0, 4.0, 0.3));
  EXPECT_TRUE(flat.legs.empty());
  EXPECT_EQ(flat.counts.bad_fit + flat.counts.bad_arc, 1);
  const LegSweep narrow = finder.find(plate(2.0, 4.0, 0.05));
  EXPECT_EQ(narrow.counts.few_points, 1);
  sim::LegConfig behind = scanner(0.0, 0.0);
  const auto scans = scene::sweeps(behind, sim::straightRow(behind.row, 5.2, 1.0, {}), Cut{100.0, 0.0, 0.0});
  const LegSweep far = finder.find(scans.at(0));
  EXPECT_TRUE(far.legs.empty());
  EXPECT_GE(far.counts.off_row, 10);
}

TEST(LegFinder, DustIsToldByItsCounts) {
  sim::LegConfig config = scanner();
  config.scanner.dust = {{.when = {0.0, 10.0}, .drop_probability = 0.9}};
  LegFinder finder({});
  int legs = 0;
  int returns = 0;
  int few = 0;
  const auto scans = rowSweeps(config, Cut{100.0, 0.1, 8.0});
  for (const Scan2D& scan : scans) {
    const LegSweep sweep = finder.find(scan);
    legs += static_cast<int>(sweep.legs.size());
    returns += sweep.counts.returns;
    few += sweep.counts.few_points;
    EXPECT_EQ(sweep.view == LegView::Legs, !sweep.legs.empty());
    EXPECT_EQ(sweep.counts.beams, 721);
  }
  const auto sweeps = static_cast<int>(scans.size());
  EXPECT_LT(legs, sweeps);          // 17 a sweep in clear air
  EXPECT_LT(returns, 30 * sweeps);  // 190 in clear air
  EXPECT_GT(few, 5 * sweeps);
  config.scanner.dust[0].drop_probability = 1.0;
  const LegSweep blind = finder.find(rowSweeps(config, Cut{100.0, 0.0, 0.0}).at(0));
  EXPECT_EQ(blind.view, LegView::NoReturns);
  EXPECT_EQ(blind.counts.returns, 0);
  EXPECT_EQ(blind.counts.beams, 721);
}

TEST(LegFinder, AnswersAnyScan) {
  LegFinder finder({});
  EXPECT_EQ(finder.find(Scan2D{}).view, LegView::NoReturns);
  const std::vector<float> odd{0.0F,
                               -1.0F,
                               std::numeric_limits<float>::quiet_NaN(),
                               std::numeric_limits<float>::infinity(),
                               -std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::denorm_min(),
                               std::numeric_limits<float>::max(),
                               15.0F,
                               4.0F,
                               4.02F};
  RandomStream random(9, 9);
  const auto pick = [&random](std::size_t n) {
    return std::min(static_cast<std::size_t>(random.uniform() * static_cast<double>(n)), n - 1);
  };
  for (int i = 0; i < 3000; ++i) {
    Scan2D scan{.angle_first = random.uniform(-4.0, 4.0), .range_max = 15.0};
    scan.angle_step = std::vector<double>{0.0043, -0.0043, 0.0, 2.0, std::nan(""), HUGE_VAL}[pick(6)];
    if (i % 7 == 0) scan.range_max = std::vector<double>{0.0, -1.0, HUGE_VAL, std::nan("")}[pick(4)];
    const std::size_t beams = pick(1000);
    const bool wild = random.bernoulli(0.5);
    for (std::size_t b = 0; b < beams; ++b) {
      const double near = random.uniform(3.9, 4.4);
      scan.ranges.push_back(wild ? odd[pick(odd.size())] : static_cast<float>(near));
    }
    scan.valid.assign(i % 5 == 0 ? pick(1000) : beams, 1);
    const LegSweep sweep = finder.find(scan);
    EXPECT_EQ(sweep.counts.clusters, judged(sweep.counts) + static_cast<int>(sweep.legs.size()));
    for (const LegDetection& leg : sweep.legs) {
      EXPECT_TRUE(leg.centre.allFinite() && leg.covariance.allFinite());
      EXPECT_GT(leg.covariance.determinant(), 0.0);
    }
  }
}

TEST(LegFinder, SameScanSameAnswer) {
  const auto scans = rowSweeps(scanner(), Cut{100.0, 0.5, 1.0});
  LegFinder used({});
  for (const Scan2D& scan : scans) (void)used.find(scan);
  LegFinder fresh({});
  const LegSweep a = used.find(scans.at(3));
  const LegSweep b = fresh.find(scans.at(3));
  ASSERT_EQ(a.legs.size(), b.legs.size());
  for (std::size_t i = 0; i < a.legs.size(); ++i) EXPECT_EQ(a.legs[i].centre, b.legs[i].centre);
}

TEST(LegFinder, RefusesSettingsThatCannotBe) {
  EXPECT_THROW(LegFinder({.diameter = 0.0}), ConfigError);
  EXPECT_THROW(LegFinder({.points_min = 2}), ConfigError);
  EXPECT_THROW(LegFinder({.width_max = 0.3}), ConfigError);
  EXPECT_THROW(LegFinder({.tilt = 1.2}), ConfigError);
  EXPECT_THROW(LegFinder({.calibration = {.a2 = -1.0}}), ConfigError);
}

}  // namespace pos::lidar
