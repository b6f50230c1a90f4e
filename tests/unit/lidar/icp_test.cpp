#include "pos/lidar/icp.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "gate_scene.hpp"
#include "pos/core/chi_square.hpp"
#include "pos/core/error.hpp"
#include "pos/core/square.hpp"

namespace pos::lidar {
namespace {

using scene::fan;
using scene::gateAlone;
using scene::gateAndFace;
using scene::sweepAt;

/// Facing along the face, about its end.
constexpr Pose2 kEnd{0.0, 0.0, 0.5 * kPi};

struct Sweeps {
  std::vector<WallPoint> first;
  std::vector<WallPoint> second;
};

Sweeps sweepsOf(const Pose2& T_first_second, const sim::LidarConfig& config,
                const std::shared_ptr<const map::OccupancyGrid>& grid, std::uint64_t seed = 1) {
  return {wallPoints(sweepAt(kEnd, grid, config, 2 * seed)),
          wallPoints(sweepAt(kEnd * T_first_second, grid, config, 2 * seed + 1))};
}

}  // namespace

TEST(WallPoints, LieOnTheWallsAndLookAtTheScanner) {
  const auto points = wallPoints(sweepAt(kEnd, gateAndFace(), fan()));
  EXPECT_GT(points.size(), 300U);
  int square_on = 0;
  int on_wall = 0;
  for (const WallPoint& point : points) {
    const Eigen::Vector2d p = kEnd * point.p;
    const Eigen::Vector2d n = rotation2(kEnd.yaw) * point.normal;
    const double off_gate = std::abs(std::abs(p.y()) - 2.5);
    const double off_face = std::min(std::abs(p.x() + 6.0), std::abs(p.x() - 3.0));
    EXPECT_LT(std::min(off_gate, off_face), 0.03) << p.transpose();  // close to corners
    if (std::min(off_gate, off_face) < 1e-5) ++on_wall;
    EXPECT_LT(point.normal.dot(point.p), 0.0);
    EXPECT_NEAR(point.normal.norm(), 1.0, 1e-12);
    if (std::max(std::abs(n.x()), std::abs(n.y())) > 1.0 - 1e-9) ++square_on;
  }
  EXPECT_GT(on_wall, 95 * static_cast<int>(points.size()) / 100);
  EXPECT_GT(square_on, 95 * static_cast<int>(points.size()) / 100);
}

// Spec B, C3 property 17.
TEST(Registration, RecoversAnyMoveOverACorner) {
  RandomStream random(7, 1);
  for (int i = 0; i < 60; ++i) {
    const double distance = 0.5 * random.uniform();
    const double bearing = random.uniform(-kPi, kPi);
    const double turn = radians(random.uniform(-3.0, 3.0));
    const Pose2 truth{distance * std::cos(bearing), distance * std::sin(bearing), turn};
    const Sweeps sweeps = sweepsOf(truth, fan(), gateAndFace());
    const IcpResult result = registered(sweeps.first, sweeps.second, {});
    ASSERT_EQ(result.end, IcpEnd::Converged) << i;
    EXPECT_LT(minus(result.T_first_second, truth).cwiseAbs().maxCoeff(), 1e-6) << i;
    EXPECT_FALSE(result.weak);
    EXPECT_GE(result.shares[1], result.shares[0]);
    EXPECT_EQ(rotation2(result.T_first_second.yaw).determinant() > 0.0, true);
    const IcpResult back = registered(sweeps.second, sweeps.first, {});
    const Pose2 round = result.T_first_second * back.T_first_second;
    EXPECT_LT(minus(round, {}).cwiseAbs().maxCoeff(), 2e-6) << i;
  }
}

TEST(Registration, ParallelWallsAreWeakAlongThemselves) {
  const Pose2 truth{0.2, -0.1, radians(1.0)};  // x across the gate, y along it
  const Sweeps sweeps = sweepsOf(truth, fan(), gateAlone());
  const Pose2 guess{0.0, 0.3, 0.0};
  const IcpResult result = registered(sweeps.first, sweeps.second, guess);
  EXPECT_EQ(result.end, IcpEnd::Converged);
  EXPECT_TRUE(result.weak);
  EXPECT_LT(result.shares[0], 1e-6);
  EXPECT_GT(std::abs(result.weak_axis.y()), 0.999);
  EXPECT_NEAR(result.T_first_second.x, truth.x, 1e-6);
  EXPECT_NEAR(result.T_first_second.yaw, truth.yaw, 1e-6);
  EXPECT_NEAR(result.T_first_second.y, guess.y, 0.01);  // not told by the walls: the guess stays
  EXPECT_GT(std::sqrt(result.covariance(1, 1)), 1.0);
  EXPECT_LT(std::sqrt(result.covariance(0, 0)), 0.01);
}

// Errors of 40 registrations with noise, in units of their covariance: chi-square with 3 degrees of freedom.
TEST(Registration, CovarianceIsAboutThatOfTheScatter) {
  const Pose2 truth{0.1, -0.9, radians(0.4)};
  double sum = 0.0;
  Vector<3> mean = Vector<3>::Zero();
  constexpr int kRuns = 40;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const Sweeps sweeps = sweepsOf(truth, fan(0.010), gateAndFace(), seed);
    const IcpResult result = registered(sweeps.first, sweeps.second, {0.0, -1.0, 0.0});
    ASSERT_EQ(result.end, IcpEnd::Converged);
    const Vector<3> error = minus(result.T_first_second, truth);
    mean += error / kRuns;
    sum += error.dot(result.covariance.llt().solve(error)) / kRuns;
    EXPECT_LT(error.head<2>().cwiseAbs().maxCoeff(), 0.01);
  }
  const Interval bounds = meanChiSquareBounds(0.999, 3.0, kRuns);
  EXPECT_GT(sum, bounds.low);
  EXPECT_LT(sum, bounds.high);
  EXPECT_LT(mean.head<2>().cwiseAbs().maxCoeff(), 0.002);
}

TEST(Registration, TellsWhenThereIsNothingToRegister) {
  const std::vector<WallPoint> none;
  const Pose2 guess{0.3, 0.2, 0.1};
  const IcpResult result = registered(none, none, guess);
  EXPECT_EQ(result.end, IcpEnd::TooFewPairs);
  EXPECT_EQ(result.T_first_second, guess);
  const auto wall = wallPoints(sweepAt(kEnd, gateAndFace(), fan()));
  EXPECT_EQ(registered(wall, none, guess).end, IcpEnd::TooFewPairs);
  EXPECT_EQ(registered(wall, wall, {60.0, 0.0, 0.0}).end, IcpEnd::TooFewPairs);
}

TEST(Registration, SameSweepStaysWhereItIs) {
  const auto wall = wallPoints(sweepAt(kEnd, gateAndFace(), fan(0.010)));
  const IcpResult result = registered(wall, wall, {});
  EXPECT_EQ(result.end, IcpEnd::Converged);
  EXPECT_LT(minus(result.T_first_second, {}).norm(), 1e-12);
  EXPECT_EQ(result.iterations, 1);
}

TEST(WallPoints, AnyScanIsAnswered) {
  RandomStream random(7, 3);
  EXPECT_TRUE(wallPoints(Scan2D{}).empty());
  const std::vector<float> odd{0.0F,
                               -1.0F,
                               std::numeric_limits<float>::quiet_NaN(),
                               std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::max(),
                               30.0F};
  for (int i = 0; i < 500; ++i) {
    Scan2D scan{.angle_step = i % 9 == 0 ? std::nan("") : 0.0043, .range_max = i % 11 == 0 ? HUGE_VAL : 30.0};
    for (int beam = 0; beam < 300; ++beam) {
      const double near = random.uniform(0.0, 10.0);
      const bool wild = random.bernoulli(0.3);
      const auto pick = static_cast<std::size_t>(random.uniform() * static_cast<double>(odd.size()));
      scan.ranges.push_back(wild ? odd[pick] : static_cast<float>(near));
    }
    scan.valid.assign(i % 5 == 0 ? 100 : 300, 1);
    const auto points = wallPoints(scan);
    for (const WallPoint& point : points) EXPECT_TRUE(point.p.allFinite() && point.normal.allFinite());
    const IcpResult result = registered(points, points, {0.1, 0.1, 0.05}, {.pairs_min = 3});
    EXPECT_TRUE(std::isfinite(result.T_first_second.x) && std::isfinite(result.T_first_second.yaw));
  }
}

TEST(Registration, RefusesSettingsThatCannotBe) {
  EXPECT_THROW((void)validated(IcpConfig{.keep = 0.0}), ConfigError);
  EXPECT_THROW((void)validated(IcpConfig{.pairs_min = 2}), ConfigError);
  EXPECT_THROW((void)validated(IcpConfig{.sigma = 0.0}), ConfigError);
  EXPECT_NO_THROW((void)validated(IcpConfig{}));
}

}  // namespace pos::lidar
