#include "pos/estimation/seamless.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "pos/core/random.hpp"

namespace pos::estimation {
namespace {

constexpr double kGravity = 9.80665;
constexpr double kSpeed = 5.0;  // m/s, from the second second on

Stamp at(double t) {
  return stampFromSeconds(1000.0 + t);
}

/// A road along x with the portal at 60 m and hand-over to 100 m, anchors on both walls.
std::shared_ptr<map::TunnelMap> mine() {
  auto mine = std::make_shared<map::TunnelMap>();
  mine->name = "mine";
  mine->origin = map::GeodeticOrigin{.latitude = 0.6, .longitude = 2.0, .altitude = 30.0};
  map::Roadway road;
  road.id = "road";
  road.centreline = {{.p_map = {0, 0, 0}}, {.p_map = {300, 0, 0}}};
  road.width = 5;
  mine->roadways = {road};
  mine->portals = {{.id = "P", .place = {"road", 60.0}, .handover_from = 50.0, .handover_to = 100.0}};
  for (int i = 0; i < 12; ++i) {
    mine->anchors.push_back(
        {.id = i + 1, .p_map = {40.0 + 15.0 * i, i % 2 == 0 ? 2.5 : -2.5, i % 4 < 2 ? 0.5 : 3.0}});
  }
  return mine;
}

/// Rest for 4 s, 2 s of acceleration, then steady along x.
double placeAt(double t) {
  if (t < 4.0) return 0.0;
  if (t < 6.0) return 0.5 * 2.5 * (t - 4.0) * (t - 4.0);
  return 5.0 + kSpeed * (t - 6.0);
}

struct Drive {
  double until = 30.0;
  double gnss_sigma = 0.02;
  double gnss_wrong_from = 1e9;    ///< m, from here on fixes are 5 m off
  double gnss_until = 100.0;       ///< m
  double uwb_from = 50.0;          ///< m
  double sixth_anchor_long = 0.0;  ///< m, on all its ranges
  std::uint64_t seed = 1;
};

std::vector<Measurement> measured(const map::TunnelMap& map, const Drive& drive) {
  const map::LocalFrame frame(*map.origin);
  RandomStream random(drive.seed, 0);
  std::vector<Measurement> log;
  const int steps = static_cast<int>(drive.until * 200.0);
  for (int i = 1; i <= steps; ++i) {
    const double t = i / 200.0;
    if (i % 20 == 7) {
      const double t_fix = t - 0.002;
      const double x = placeAt(t_fix);
      const Eigen::Vector3d noise = drive.gnss_sigma * normals(random);
      const Eigen::Vector3d wrong(0.0, x > drive.gnss_wrong_from ? 5.0 : 0.0, 0.0);
      const auto g = frame.toGeodetic(Eigen::Vector3d(x, 0, 0) + noise + wrong);
      const GnssFix fix{.latitude = g.latitude,
                        .longitude = g.longitude,
                        .altitude = g.altitude,
                        .covariance_enu = drive.gnss_sigma * drive.gnss_sigma * Matrix<3, 3>::Identity()};
      if (x < drive.gnss_until) log.push_back({at(t_fix), "gnss", fix});
    }
    if (i % 4 == 1) {
      const double t_range = t - 0.001;
      const Eigen::Vector3d tag(placeAt(t_range), 0, 1);
      for (const map::Anchor& anchor : map.anchors) {
        const double distance = (tag - anchor.p_map).norm();
        const double noise = random.normal(0.0, 0.1);
        if (tag.x() < drive.uwb_from || distance > 40.0) continue;
        log.push_back(
            {at(t_range), "uwb",
             BeaconRange{.tag = 1,
                         .anchor = anchor.id,
                         .range = distance + noise + (anchor.id == 6 ? drive.sixth_anchor_long : 0.0),
                         .tag_body = Eigen::Vector3d(0, 0, 1)}});
      }
    }
    const double force = t > 4.0 && t <= 6.0 ? 2.5 : 0.0;
    ImuSample sample;
    sample.linear = Eigen::Vector3d(force, 0, kGravity) + 0.02 * normals(random);
    sample.angular = 0.002 * normals(random);
    log.push_back({at(t), "imu", sample});
  }
  return log;
}

SeamlessConfig settings() {
  SeamlessConfig config;
  config.variant = SeamlessConfig::Variant::Imm;
  config.standstill.threshold = 12.0;
  config.uwb.robust.form = filters::RobustConfig::Form::None;
  return config;
}

struct Told {
  double largest = 0.0;          ///< m, error after the alignment
  double largest_dark = 0.0;     ///< m, error beyond 105 m
  double probability_uwb = 0.0;  ///< at the end
  bool gnss_usable = false;      ///< at the end
  int masked = 0;
};

Told told(const SeamlessConfig& config, const Drive& drive) {
  const auto map = mine();
  Seamless estimator(config, map);
  Told result;
  for (const Measurement& measurement : measured(*map, drive)) {
    const IngestReport report = estimator.ingest(measurement);
    if (report.reason.find("masked") != std::string_view::npos) ++result.masked;
    const auto estimate = estimator.estimateAt(measurement.stamp);
    if (!estimate || estimate->modes.empty()) continue;
    const double x = placeAt(seconds(measurement.stamp - at(0.0)));
    const double error = (estimate->T_map_body.translation - Eigen::Vector3d(x, 0, 0)).norm();
    if (measurement.stamp > at(3.0)) result.largest = std::max(result.largest, error);
    if (x > 105.0) result.largest_dark = std::max(result.largest_dark, error);
    EXPECT_NEAR(estimate->modes[0].probability + estimate->modes[1].probability, 1.0, 1e-12);
    result.probability_uwb = estimate->modes[1].probability;
    result.gnss_usable = estimate->modes[0].usable;
  }
  return result;
}

}  // namespace

TEST(Seamless, CrossesThePortalInEveryVariant) {
  using filters::FuzzyVariant;
  SeamlessConfig config = settings();
  EXPECT_LT(told(config, {}).largest, 0.5);
  config.variant = SeamlessConfig::Variant::Faimm;
  for (const FuzzyVariant variant :
       {FuzzyVariant::Paper, FuzzyVariant::PaperSym, FuzzyVariant::Centroid, FuzzyVariant::Incremental}) {
    config.fuzzy.variant = variant;
    const Told end = told(config, {});
    EXPECT_LT(end.largest, 0.5);
    EXPECT_GT(end.probability_uwb, 0.99);
    EXPECT_FALSE(end.gnss_usable);
  }
}

TEST(Seamless, SatellitesUnderGroundAreMaskedByTheMap) {
  const Drive leak{.gnss_wrong_from = 100.0, .gnss_until = 1e9};
  const Told automatic = told(settings(), leak);
  EXPECT_GT(automatic.masked, 40);
  EXPECT_FALSE(automatic.gnss_usable);
  EXPECT_LT(automatic.largest_dark, 0.5);
}

TEST(Seamless, WithoutTheMaskWrongFixesThatClaimCentimetresAreStillTakenForWhatTheyAre) {
  SeamlessConfig config = settings();
  config.gnss.mask = GnssUse::Mask::Off;
  const Drive leak{.gnss_wrong_from = 100.0, .gnss_until = 1e9};
  EXPECT_EQ(told(config, leak).masked, 0);
  EXPECT_LT(told(config, leak).largest_dark, 0.5);
  config.gnss.surprise = GnssUse::Surprise::Gate;
  EXPECT_LT(told(config, leak).largest_dark, 0.5);
}

TEST(Seamless, TheOperatorsMaskKeepsSatellitesOutEverywhere) {
  SeamlessConfig config = settings();
  config.gnss.mask = GnssUse::Mask::Always;
  config.start.position_sigma = 0.05;
  const Told end = told(config, {.until = 8.0});
  EXPECT_GT(end.masked, 30);
  EXPECT_FALSE(end.gnss_usable);
}

TEST(Seamless, AnAnchorThatKeepsReadingTooLongGetsAnOffsetOfItsOwn) {
  const Drive drive{.until = 33.0, .gnss_until = 60.0, .sixth_anchor_long = 0.5};
  SeamlessConfig config = settings();
  config.uwb.robust.form = filters::RobustConfig::Form::Huber;
  const double without = told(config, drive).largest_dark;
  config.uwb.anchor_bias.sigma = 0.5;
  EXPECT_LT(told(config, drive).largest_dark, 0.8 * without);

  const auto map = mine();
  Seamless estimator(config, map);
  std::map<std::string, NamedValue> offsets;  // the surest while it was a state
  for (const Measurement& measurement : measured(*map, drive)) {
    (void)estimator.ingest(measurement);
    for (const NamedValue& value : estimator.diagnostics()) {
      if (value.name.find("range_offset_") != 0) continue;
      const auto [it, fresh] = offsets.emplace(value.name, value);
      if (!fresh && value.sigma < it->second.sigma) it->second = value;
    }
  }
  ASSERT_TRUE(offsets.contains("range_offset_6_m"));
  EXPECT_NEAR(offsets["range_offset_6_m"].value, 0.5, 0.1);
  EXPECT_LE(offsets.size(), 2U);  // hardly another anchor was suspected
}

TEST(Seamless, ReadingsBetweenSamplesLoseNoIncrement) {
  // Fixes of no weight between the samples must not change where the unit goes.
  const auto map = mine();
  SeamlessConfig config = settings();
  Seamless with(config, map);
  Seamless without(config, map);
  for (const Measurement& measurement : measured(*map, {.until = 12.0, .gnss_sigma = 500.0})) {
    if (measurement.sensor == "uwb") continue;
    (void)with.ingest(measurement);
    if (measurement.sensor == "imu") (void)without.ingest(measurement);
  }
  const auto a = with.estimateAt(at(12.0));
  const auto b = without.estimateAt(at(12.0));
  ASSERT_TRUE(a && b);
  EXPECT_LT((a->T_map_body.translation - b->T_map_body.translation).norm(), 0.05);
}

TEST(Seamless, RubbishIsRefusedAndChangesNothing) {
  const auto map = mine();
  Seamless estimator(settings(), map);
  for (const Measurement& measurement : measured(*map, {.until = 5.0})) (void)estimator.ingest(measurement);
  const auto before = estimator.estimateAt(at(5.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(estimator.ingest({at(5.0), "uwb", BeaconRange{.anchor = 1, .range = nan}}).verdict,
            Verdict::Degenerate);
  EXPECT_EQ(estimator.ingest({at(5.0), "uwb", BeaconRange{.anchor = 99, .range = 5.0}}).verdict,
            Verdict::Degenerate);
  EXPECT_EQ(estimator.ingest({at(5.0), "odometry", OdometryIncrement{}}).verdict, Verdict::Unsupported);
  EXPECT_EQ(estimator.ingest({at(4.0), "imu", ImuSample{.linear = {0, 0, 9.8}}}).verdict, Verdict::TooOld);
  const auto after = estimator.estimateAt(at(5.0));
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->T_map_body.translation, after->T_map_body.translation);
  EXPECT_EQ(before->covariance, after->covariance);
}

TEST(Seamless, MinutesOfSilenceLeaveAnAnswerThatGrowsUnsure) {
  const auto map = mine();
  Seamless estimator(settings(), map);
  for (const Measurement& measurement : measured(*map, {.until = 20.0})) (void)estimator.ingest(measurement);
  const auto before = estimator.estimateAt(at(20.0));
  const auto after = estimator.estimateAt(at(140.0));
  ASSERT_TRUE(before && after);
  EXPECT_TRUE(after->T_map_body.translation.allFinite());
  EXPECT_GT(after->covariance(0, 0), 100.0 * before->covariance(0, 0));
}

TEST(Seamless, AMapWithoutAnchorsPortalsAndTieStillRuns) {
  const auto map = std::make_shared<map::TunnelMap>();
  Seamless estimator(settings(), map);
  for (const Measurement& measurement : measured(*mine(), {.until = 6.0})) {
    const IngestReport report = estimator.ingest(measurement);
    if (measurement.sensor == "gnss") {
      EXPECT_EQ(report.verdict, Verdict::Unsupported);
    }
    if (measurement.sensor == "uwb") {
      EXPECT_EQ(report.verdict, Verdict::Degenerate);
    }
  }
  const auto estimate = estimator.estimateAt(at(6.0));
  ASSERT_TRUE(estimate);
  EXPECT_TRUE(estimate->T_map_body.translation.allFinite());
}

TEST(Seamless, TransportOfTheErrorStateIsTheNumericOne) {
  RandomStream random(5, 0);
  for (int trial = 0; trial < 10; ++trial) {
    EskfState x_0;
    Vector<15> d;
    for (double& v : d) v = random.normal(0.0, 0.5);
    const EskfState x = plus(x_0, d);
    Matrix<15, 15> A;
    for (double& v : A.reshaped()) v = random.normal();
    const Matrix<15, 15> P = A * A.transpose();
    EXPECT_TRUE(ins::transported(x, minus(x, x_0), P)
                    .isApprox(filters::transportedNumerically<EskfState>(x, x_0, P), 1e-7));
  }
}

}  // namespace pos::estimation
