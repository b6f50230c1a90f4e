#include "pos/sim/lidar_stream.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"
#include "pos/sim/ray_cast.hpp"
#include "sensor_scene.hpp"

namespace pos::sim {
namespace {

using map::OccupancyGrid;
using scene::meanBand;
using scene::meanOf;
using scene::sigmaBand;
using scene::sigmaOf;
using scene::standing;

/// A turned and shifted grid in which every tenth cell or so is rock.
OccupancyGrid speckled(RandomStream& random) {
  OccupancyGrid grid{.T_map_grid = {3.0, -2.0, 0.4},
                     .x_min = -5.0,
                     .y_min = 1.0,
                     .resolution = 0.25,
                     .columns = 60,
                     .rows = 40};
  for (int i = 0; i < grid.columns * grid.rows; ++i) {
    const double u = random.uniform();
    grid.occupancy.push_back(u < 0.05 ? 100 : u < 0.1 ? OccupancyGrid::kUnknown : 10);
  }
  return grid;
}

/// Where the ray enters one cell, by slabs; nothing when it misses.
std::optional<double> entered(const OccupancyGrid& grid, int column, int row, const Eigen::Vector2d& o,
                              const Eigen::Vector2d& d) {
  double enter = 0.0;
  double leave = 1e9;
  for (int axis = 0; axis < 2; ++axis) {
    const double low =
        (axis == 0 ? grid.x_min + column * grid.resolution : grid.y_min + row * grid.resolution);
    const double s0 = (low - o[axis]) / d[axis];
    const double s1 = (low + grid.resolution - o[axis]) / d[axis];
    enter = std::max(enter, std::min(s0, s1));
    leave = std::min(leave, std::max(s0, s1));
  }
  return enter < leave ? std::optional(enter) : std::nullopt;
}

std::optional<double> bruteForce(const OccupancyGrid& grid, const Eigen::Vector2d& p, double heading,
                                 double range_max) {
  const Eigen::Vector2d o = inverse(grid.T_map_grid) * p;
  const double angle = heading - grid.T_map_grid.yaw;
  const Eigen::Vector2d d(std::cos(angle), std::sin(angle));
  std::optional<double> nearest;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (grid.at(column, row) != 100) continue;
      const std::optional<double> s = entered(grid, column, row, o, d);
      if (s && *s <= range_max && (!nearest || *s < *nearest)) nearest = s;
    }
  }
  return nearest;
}

/// A hall of 20 x 10 m, walls one cell thick, its inside corner at the map's origin.
std::shared_ptr<const OccupancyGrid> hall() {
  auto grid = std::make_shared<OccupancyGrid>(
      OccupancyGrid{.x_min = -0.1, .y_min = -0.1, .resolution = 0.1, .columns = 202, .rows = 102});
  for (int row = 0; row < grid->rows; ++row) {
    for (int column = 0; column < grid->columns; ++column) {
      const bool wall = row == 0 || column == 0 || row == grid->rows - 1 || column == grid->columns - 1;
      grid->occupancy.push_back(wall ? 100 : 0);
    }
  }
  return grid;
}

LidarConfig plain() {
  LidarConfig config;
  config.scanner.sigma_range = 0.0;
  config.scanner.angle_first = -kPi;
  config.scanner.angle_step = kPi / 180.0;
  config.scanner.beams = 360;
  return config;
}

/// Way from `p` to the hall's inside walls.
double toWall(const Eigen::Vector2d& p, double heading) {
  const Eigen::Vector2d d(std::cos(heading), std::sin(heading));
  const double x = std::abs(d.x()) < 1e-12 ? 1e9 : ((d.x() > 0.0 ? 20.0 : 0.0) - p.x()) / d.x();
  const double y = std::abs(d.y()) < 1e-12 ? 1e9 : ((d.y() > 0.0 ? 10.0 : 0.0) - p.y()) / d.y();
  return std::min(x, y);
}

std::vector<Scan2D> scans(const LidarConfig& config, std::shared_ptr<const Motion> motion) {
  LidarStream stream(config, hall(), std::move(motion), {.seed = 1});
  return scene::readings<Scan2D>(scene::drained(stream));
}

/// Reported minus true ranges of the valid beams of one scanner standing at (7, 4).
std::vector<double> errorsStanding(const LidarConfig& config, double duration) {
  std::vector<double> errors;
  for (const Scan2D& scan : scans(config, standing({7, 4, 1}, duration))) {
    for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
      if (scan.valid[i] == 0) continue;
      const double angle = scan.angle_first + static_cast<double>(i) * scan.angle_step;
      errors.push_back(static_cast<double>(scan.ranges[i]) - toWall({7, 4}, angle));
    }
  }
  return errors;
}

}  // namespace

TEST(RayCast, AgreesWithTryingEveryCell) {
  RandomStream random(5, 1);
  const OccupancyGrid grid = speckled(random);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d p =
        grid.T_map_grid * Eigen::Vector2d(random.uniform(-8.0, 13.0), random.uniform(-2.0, 14.0));
    const double heading = random.uniform(-kPi, kPi);
    const std::optional<double> fast = rayCast(grid, p, heading, 6.0);
    const std::optional<double> slow = bruteForce(grid, p, heading, 6.0);
    ASSERT_EQ(fast.has_value(), slow.has_value()) << p.transpose() << ' ' << heading;
    if (fast) {
      EXPECT_NEAR(*fast, *slow, 1e-9);
    }
    hits += fast ? 1 : 0;
  }
  EXPECT_GT(hits, 500);
  EXPECT_LT(hits, 1900);
}

TEST(RayCast, RunsExactlyAlongTheAxes) {
  const auto grid = hall();
  EXPECT_NEAR(*rayCast(*grid, {7.03, 4.02}, 0.0, 30.0), 12.97, 1e-12);
  EXPECT_NEAR(*rayCast(*grid, {7.03, 4.02}, kPi, 30.0), 7.03, 1e-12);
  EXPECT_NEAR(*rayCast(*grid, {7.03, 4.02}, 0.5 * kPi, 30.0), 5.98, 1e-12);
  EXPECT_FALSE(rayCast(*grid, {7.03, 4.02}, 0.0, 12.9));
  EXPECT_EQ(*rayCast(*grid, {-0.05, 4.0}, 0.0, 30.0), 0.0);
  EXPECT_FALSE(rayCast(*grid, {-5.0, 4.0}, kPi, 30.0));
}

TEST(LidarStream, WithoutErrorsRangesAreThoseToTheWalls) {
  EXPECT_EQ(errorsStanding(plain(), 0.0).size(), 360U);
  for (const double error : errorsStanding(plain(), 0.0)) EXPECT_NEAR(error, 0.0, 1e-5);  // floats
}

TEST(LidarStream, MountTurnsAndShiftsTheScan) {
  LidarConfig config = plain();
  config.scanner.T_body_sensor = Pose3::fromXyzYawPitchRoll(1.0, 0.5, 0.3, 0.7, 0.0, 0.0);
  const Eigen::Quaterniond q(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  const auto all = scans(config, std::make_shared<scene::Posed>(Eigen::Vector3d(7, 4, 1), q, 0.0));
  const Eigen::Vector3d sensor = Eigen::Vector3d(7, 4, 1) + q * Eigen::Vector3d(1.0, 0.5, 0.3);
  ASSERT_EQ(all.size(), 1U);
  for (std::size_t i = 0; i < all[0].ranges.size(); ++i) {
    const double heading = all[0].angle_first + static_cast<double>(i) * all[0].angle_step + 1.1;
    EXPECT_NEAR(static_cast<double>(all[0].ranges[i]), toWall(sensor.head<2>(), heading), 1e-5);
  }
}

TEST(LidarStream, PitchedScannerMeetsUprightWallsFartherOut) {
  LidarConfig config = plain();
  config.scanner.angle_first = 0.0;
  config.scanner.beams = 1;
  config.scanner.T_body_sensor = Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, 0.0, 0.3, 0.0);
  const auto all = scans(config, standing({7, 4, 1}, 0.0));
  EXPECT_NEAR(static_cast<double>(all[0].ranges[0]), 13.0 / std::cos(0.3), 1e-5);
}

TEST(LidarStream, RangeNoiseHasItsSigma) {
  LidarConfig config = plain();
  config.scanner.sigma_range = 0.01;
  const std::vector<double> errors = errorsStanding(config, 4.0);
  EXPECT_NEAR(meanOf(errors), 0.0, meanBand(0.01, errors.size()));
  EXPECT_NEAR(sigmaOf(errors), 0.01, sigmaBand(0.01, errors.size()));
}

TEST(LidarStream, AngleNoiseShowsOnAnObliqueWall) {
  LidarConfig config = plain();
  config.timing.rate = 1000.0;
  config.scanner.angle_first = kPi / 6.0;
  config.scanner.beams = 1;
  config.scanner.sigma_angle = 0.001;
  // To the wall y = 10 at 30 degrees: range 6 / sin a, so dr/da = -12 cos(30) / sin(30).
  const std::vector<double> errors = errorsStanding(config, 10.0);
  const double expected = 0.001 * 12.0 * std::sqrt(3.0);
  EXPECT_NEAR(sigmaOf(errors), expected, sigmaBand(expected, errors.size()) + 1e-4 * expected);
}

TEST(LidarStream, BeamsLookWhereTheErrorPolynomialSays) {
  LidarConfig config = plain();
  config.scanner.angle_first = 0.0;
  config.scanner.beams = 181;
  config.scanner.errors = LidarErrors::paper();
  const auto all = scans(config, standing({7, 4, 1}, 0.0));
  for (std::size_t i = 0; i < all[0].ranges.size(); ++i) {
    const double m = static_cast<double>(i);
    const double true_deg = 4e-5 * m * m + 0.9925 * m + 0.0531;
    EXPECT_NEAR(static_cast<double>(all[0].ranges[i]), 1.0006 * toWall({7, 4}, radians(true_deg)) + 0.035,
                1e-5);
  }
}

TEST(LidarStream, DustDropsItsShareOfBeamsWhileItHangs) {
  LidarConfig config = plain();
  config.scanner.drop_probability = 0.02;
  config.scanner.dust = {{.when = {2.0, 4.0}, .drop_probability = 0.6}};
  double clear = 0.0;
  double dusty = 0.0;
  const auto all = scans(config, standing({7, 4, 1}, 3.99));
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (const std::uint8_t valid : all[k].valid) (k < 50 ? clear : dusty) += valid != 0 ? 0.0 : 1.0;
  }
  ASSERT_EQ(all.size(), 100U);
  EXPECT_NEAR(clear / 18000.0, 0.02, scene::rateBand(0.02, 18000));
  EXPECT_NEAR(dusty / 18000.0, 0.6, scene::rateBand(0.6, 18000));
}

TEST(LidarStream, ReturnsBeyondItsLimitsAreInvalid) {
  LidarConfig config = plain();
  config.scanner.range_max = 6.5;
  config.scanner.range_min = 5.0;
  const auto all = scans(config, standing({7, 4, 1}, 0.0));
  for (std::size_t i = 0; i < all[0].ranges.size(); ++i) {
    const double wall = toWall({7, 4}, all[0].angle_first + static_cast<double>(i) * all[0].angle_step);
    EXPECT_EQ(all[0].valid[i] != 0, wall >= 5.0 && wall <= 6.5) << i;
  }
}

TEST(LidarStream, SameSeedSameBytes) {
  LidarConfig config = plain();
  config.scanner.sigma_range = 0.01;
  config.scanner.drop_probability = 0.1;
  const auto text = [&](std::uint64_t seed) {
    LidarStream stream(config, hall(), standing({7, 4, 1}, 1.0), {.seed = seed});
    return scene::spelled(scene::drained(stream));
  };
  EXPECT_EQ(text(1), text(1));
  EXPECT_NE(text(1), text(2));
}

TEST(LidarStream, RefusesAScannerThatCannotBe) {
  LidarConfig config = plain();
  config.scanner.errors = LidarErrors::paper();  // beams from -180 degrees
  EXPECT_THROW((void)validated(config), ConfigError);
  config = plain();
  config.scanner.beams = 0;
  EXPECT_THROW((void)validated(config), ConfigError);
  EXPECT_THROW(LidarStream(plain(), nullptr, standing({0, 0, 0}, 1.0), {}), ConfigError);
}

}  // namespace pos::sim
