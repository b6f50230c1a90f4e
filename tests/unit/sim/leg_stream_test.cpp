#include "pos/sim/leg_stream.hpp"

#include <gtest/gtest.h>

#include <set>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"
#include "sensor_scene.hpp"

namespace pos::sim {
namespace {

using scene::meanOf;
using scene::sigmaOf;

/// A shearer that faces north (+y) and stands or cuts along x = 0; supports to its left at x = -4.
class Cut : public scene::PlainMotion {
 public:
  Cut(double y, double speed, double duration) : PlainMotion(duration), y_(y), speed_(speed) {}
  Kinematics at(double t) const override {
    Kinematics k;
    k.p_map = {0.0, y_ + speed_ * t, 0.0};
    k.v_map = {0.0, speed_, 0.0};
    k.R_map_body = Eigen::AngleAxisd(0.5 * kPi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return k;
  }
  double travelled(double t) const override { return speed_ * t; }

 private:
  double y_;
  double speed_;
};

std::shared_ptr<const Motion> standingAt(double y, double duration = 0.0) {
  return std::make_shared<Cut>(y, 0.0, duration);
}

LegConfig quiet(LegModel model) {
  LegConfig config;
  config.model = model;
  config.scanner.sigma_range = 0.0;
  return config;
}

LegPlacer fixedRow(const LegConfig& config) {
  return straightRow(config.row, 4.0, 1.0, {});
}

std::vector<Scan2D> scans(const LegConfig& config, const LegPlacer& leg, std::shared_ptr<const Motion> motion,
                          std::uint64_t seed = 1) {
  LegStream stream(config, leg, std::move(motion), {.seed = seed});
  return scene::readings<Scan2D>(scene::drained(stream));
}

/// The point a one-beam scan measured, body axes.
Eigen::Vector3d pointOf(const Scan2D& scan) {
  return scan.T_body_sensor * Eigen::Vector3d(static_cast<double>(scan.ranges.at(0)), 0.0, 0.0);
}

std::size_t returns(const Scan2D& scan) {
  return static_cast<std::size_t>(std::count(scan.valid.begin(), scan.valid.end(), std::uint8_t{1}));
}

}  // namespace

TEST(SupportLegs, BeamEndsOnTheCylinderAndNotBehindIt) {
  RandomStream random(2, 1);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    LegCylinder leg;
    leg.point = {random.uniform(-6.0, 6.0), random.uniform(-6.0, 6.0), random.uniform(-1.0, 1.0)};
    leg.axis = Eigen::Vector3d(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 1.0).normalized();
    leg.radius = 0.5;
    const double angle = random.uniform(-kPi, kPi);
    const auto off = [&](double s) {
      const Eigen::Vector3d p(s * std::cos(angle), s * std::sin(angle), 0.0);
      return (p - leg.point).cross(leg.axis).norm() - leg.radius;
    };
    if (off(0.0) <= 0.0) continue;
    std::optional<double> first;  // by small steps
    for (double s = 0.0; s < 10.0 && !first; s += 0.002) {
      if (off(s) < 0.0) first = s;
    }
    const std::optional<double> range = beamRange(leg, angle);
    if (first) {
      ++hits;
      ASSERT_TRUE(range);
      EXPECT_NEAR(*range, *first, 0.0021);
    }
    if (range) {
      EXPECT_NEAR(off(*range), 0.0, 1e-9);
    }
  }
  EXPECT_GT(hits, 100);
}

// Spec B, B5: ellipse axes r and r / cos 10 deg = 1.0154 r.
TEST(SupportLegs, TiltedLegIsAnEllipseInTheScanPlane) {
  const LegCylinder leg{.point = {5.0, 1.0, 0.3},
                        .axis = {std::sin(radians(10.0)), 0.0, std::cos(radians(10.0))},
                        .radius = 0.15};
  const LegEllipse ellipse = cutByScanPlane(leg);
  EXPECT_NEAR(ellipse.semi_minor, 0.15, 1e-15);
  EXPECT_NEAR(ellipse.semi_major / ellipse.semi_minor, 1.0154, 5e-5);
  EXPECT_NEAR(ellipse.centre.x(), 5.0 - 0.3 * std::tan(radians(10.0)), 1e-12);
  EXPECT_NEAR(ellipse.centre.y(), 1.0, 1e-12);
  int hits = 0;
  for (double angle = 0.1; angle < 0.3; angle += 0.001) {
    const std::optional<double> range = beamRange(leg, angle);
    if (!range) continue;
    ++hits;
    const double x = *range * std::cos(angle) - ellipse.centre.x();
    const double y = *range * std::sin(angle) - ellipse.centre.y();
    EXPECT_NEAR(std::hypot(x / ellipse.semi_major, y / ellipse.semi_minor), 1.0, 1e-9);
  }
  EXPECT_GT(hits, 30);
}

// Spec B, B5: 5, 7 and 9 points for legs of 0.10, 0.15 and 0.20 m at 9 m along the face and 0.25 deg.
TEST(LegStream, LegGivesTheKnownNumberOfPoints) {
  const std::vector<std::pair<double, int>> facts{{0.10, 5}, {0.15, 7}, {0.20, 9}};
  for (const auto& [radius, points] : facts) {
    LegConfig config = quiet(LegModel::Legs);
    config.row.count = 1;
    config.row.station_first = 0.0;
    config.row.radius = radius;
    config.row.station_slack = 0.0;
    std::vector<double> counts;
    for (int i = 0; i < 200; ++i) {  // over many places of the leg between the beams
      counts.push_back(
          static_cast<double>(returns(scans(config, fixedRow(config), standingAt(8.9 + 0.001 * i))[0])));
    }
    EXPECT_EQ(std::lround(meanOf(counts)), points);
  }
}

TEST(LegStream, SweepSeesTheNearSideOfEveryLegNotHidden) {
  LegConfig config = quiet(LegModel::Legs);
  config.row.tilt = 0.0;
  const auto all = scans(config, fixedRow(config), standingAt(150.3));
  ASSERT_EQ(all.size(), 1U);
  ASSERT_EQ(all[0].ranges.size(), 721U);
  std::set<long> seen;
  for (std::size_t i = 0; i < all[0].ranges.size(); ++i) {
    if (all[0].valid[i] == 0) continue;
    const double angle = all[0].angle_first + static_cast<double>(i) * all[0].angle_step;
    const Eigen::Vector2d p(static_cast<double>(all[0].ranges[i]) * std::cos(angle),
                            static_cast<double>(all[0].ranges[i]) * std::sin(angle));  // x forward, y left
    const double station = 150.3 + p.x();
    const long support = std::lround((station + 15.0) / 1.5);
    const Eigen::Vector2d centre(-15.0 + 1.5 * static_cast<double>(support) - 150.3, 4.0);
    EXPECT_NEAR((p - centre).norm(), 0.15, 1e-5);
    EXPECT_LT(p.norm(), centre.norm());
    seen.insert(support);
  }
  EXPECT_EQ(seen.size(), 17U);  // 13 m each way at 1.5 m
}

TEST(LegStream, NearLegHidesTheOneBehindIt) {
  LegConfig config = quiet(LegModel::Legs);
  config.row.count = 2;
  const LegPlacer in_line = [](int support, double) { return Eigen::Vector3d(-4.0 - support, 0.0, 0.0); };
  config.row.station_first = 0.0;
  config.row.spacing = 0.1;
  const auto all = scans(config, in_line, standingAt(0.0));
  for (std::size_t i = 0; i < all[0].ranges.size(); ++i) {
    if (all[0].valid[i] != 0) {
      EXPECT_LT(all[0].ranges[i], 4.2F);
    }
  }
  EXPECT_GT(returns(all[0]), 10U);
}

TEST(LegStream, PointsAreTheLegsThemselves) {
  LegConfig config = quiet(LegModel::Points);
  config.scanner.T_body_sensor = Pose3::fromXyzYawPitchRoll(0.5, 0.2, 0.4, 0.0, 0.0, 0.0);
  const LegPlacer bumpy = [row = config.row](int support, double) {
    return Eigen::Vector3d(-4.0, row.station_first + support * row.spacing, 0.02 * support - 2.0);
  };
  std::vector<double> stations;
  for (const Scan2D& scan : scans(config, bumpy, standingAt(150.3))) {
    ASSERT_EQ(scan.ranges.size(), 1U);
    const Eigen::Vector3d body = pointOf(scan);
    const Eigen::Vector3d map(-body.y(), 150.3 + body.x(), body.z());
    const int support = static_cast<int>(std::lround((map.y() + 15.0) / 1.5));
    EXPECT_LT((map - bumpy(support, 0.0)).norm(), 2e-6);
    stations.push_back(map.y());
  }
  EXPECT_EQ(stations.size(), 18U);  // the scanner is at 150.8: stations 138 to 163.5
  EXPECT_TRUE(std::is_sorted(stations.begin(), stations.end()));
}

TEST(LegStream, MountErrorTurnsWhatTheNominalMountSays) {
  LegConfig config = quiet(LegModel::Points);
  config.mount_error = {-0.0002, 0.0, 0.004};
  const Eigen::AngleAxisd turn(config.mount_error.norm(), config.mount_error.normalized());
  for (const Scan2D& scan : scans(config, fixedRow(config), standingAt(150.3))) {
    const Eigen::Vector3d true_body = turn * pointOf(scan);  // C_true = exp(error) C_nominal
    EXPECT_NEAR(true_body.y(), 4.0, 2e-6);
    EXPECT_NEAR(true_body.z(), 0.0, 2e-6);
  }
}

TEST(LegStream, PointsCarryTheScannersSystematicErrors) {
  LegConfig config = quiet(LegModel::Points);
  config.scanner.errors = LidarErrors::paper();
  const auto all = scans(config, fixedRow(config), standingAt(150.0));
  for (const Scan2D& scan : all) {
    const Eigen::Vector3d p = pointOf(scan);
    const double bearing = trueAngle(std::atan2(p.y(), p.x()), config.scanner.errors);
    const double range = (p.norm() - 0.035) / 1.0006;
    EXPECT_NEAR(range * std::sin(bearing), 4.0, 2e-6);
    const double support = (150.0 + range * std::cos(bearing) + 15.0) / 1.5;
    EXPECT_NEAR(support, std::round(support), 2e-6);
  }
}

TEST(LegStream, NoiseHasItsSigmas) {
  LegConfig config = quiet(LegModel::Points);
  config.row.count = 1;
  config.row.station_first = 0.0;
  config.scanner.sigma_range = 0.010;
  config.scanner.sigma_angle = 0.0004;
  std::vector<double> ranges;
  std::vector<double> bearings;
  for (const Scan2D& scan : scans(config, fixedRow(config), standingAt(3.0, 400.0))) {
    ranges.push_back(pointOf(scan).norm() - 5.0);
    bearings.push_back(std::atan2(pointOf(scan).y(), pointOf(scan).x()) - std::atan2(4.0, -3.0));
  }
  EXPECT_EQ(ranges.size(), 10001U);
  EXPECT_NEAR(meanOf(ranges), 0.0, scene::meanBand(0.010, ranges.size()));
  EXPECT_NEAR(sigmaOf(ranges), 0.010, scene::sigmaBand(0.010, ranges.size()));
  EXPECT_NEAR(meanOf(bearings), 0.0, scene::meanBand(0.0004, bearings.size()));
  EXPECT_NEAR(sigmaOf(bearings), 0.0004, scene::sigmaBand(0.0004, bearings.size()));
}

TEST(LegStream, RowAdvancesAtItsTimes) {
  const SupportRow row;
  const LegPlacer leg = straightRow(row, 4.0, 1.0, {10.0, 20.0});
  EXPECT_TRUE(leg(10, 9.9).isApprox(Eigen::Vector3d(-4.0, 0.0, 0.0)));
  EXPECT_TRUE(leg(10, 10.0).isApprox(Eigen::Vector3d(-3.0, 0.0, 0.0)));
  EXPECT_TRUE(leg(11, 25.0).isApprox(Eigen::Vector3d(-2.0, 1.5, 0.0)));
}

TEST(SupportLegs, SupportsNearHoldsAllWithinReach) {
  SupportRow row;
  row.station_slack = 0.0;
  for (double station = -30.0; station < 400.0; station += 0.37) {
    const SupportSpan span = supportsNear(row, station, 13.0);
    for (int support = 0; support < row.count; ++support) {
      const bool near = std::abs(row.station_first + support * row.spacing - station) <= 13.0;
      EXPECT_EQ(near, support >= span.first && support < span.last) << station << ' ' << support;
    }
  }
}

TEST(LegStream, SameSeedSameBytes) {
  for (const LegModel model : {LegModel::Legs, LegModel::Points}) {
    LegConfig config;
    config.model = model;
    config.scanner.drop_probability = 0.05;
    const auto text = [&](std::uint64_t seed) {
      LegStream stream(config, fixedRow(config), std::make_shared<Cut>(10.0, 0.1, 4.0), {.seed = seed});
      return scene::spelled(scene::drained(stream));
    };
    EXPECT_EQ(text(1), text(1));
    EXPECT_NE(text(1), text(2));
  }
}

TEST(LegStream, RefusesARowThatCannotBe) {
  LegConfig config = quiet(LegModel::Points);
  config.row.along_map = {0.0, 2.0};
  EXPECT_THROW((void)validated(config), ConfigError);
  config = quiet(LegModel::Points);
  config.row.radius = 0.0;
  EXPECT_THROW((void)validated(config), ConfigError);
  EXPECT_THROW(LegStream(quiet(LegModel::Points), nullptr, standingAt(0.0), {}), ConfigError);
}

}  // namespace pos::sim
