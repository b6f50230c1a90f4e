// Creep measured on the way: which sweeps are compared, and what comes of it.
#include "pos/estimation/creep_watch.hpp"

#include <gtest/gtest.h>

#include "unit/lidar/gate_scene.hpp"

namespace pos::estimation {
namespace {

constexpr double kLength = 30.0;  // m; end 2 lies at the map's origin

/// A shearer that looks along +y, with 10 mm of noise.
struct Drive {
  CreepWatch watch{FaceConfig{.y = -kLength, .length = kLength}};
  std::uint64_t seed = 1;

  /// `p` is where it really stands, `rack` what the odometer has counted; the filter is off by decimetres.
  std::optional<DwellCreep> at(const Eigen::Vector2d& p, double speed, double rack) {
    static const auto grid = lidar::scene::gateAndFace();
    const Pose2 real{p.x(), p.y(), 0.5 * kPi};
    const Scan2D sweep = lidar::scene::sweepAt(real, grid, lidar::scene::fan(0.010), seed++);
    const Pose3 believed =
        Pose3::fromXyzYawPitchRoll(p.x() + 0.1, p.y() + 0.02 * speed, 0.0, 0.5 * kPi + 0.001, 0.0, 0.0);
    return watch.take(
        sweep, {.T_map_body = believed,
                .R_face_body = Eigen::AngleAxisd(0.5 * kPi, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                .station = kLength + p.y(),
                .speed = speed,
                .rack = rack});
  }
};

}  // namespace

TEST(CreepWatch, ComparesTheStandsBeforeAndAfterAnEndOperation) {
  constexpr double kCreep = -0.176;
  constexpr double kFarther = 0.03;  // m, the second stop
  Drive drive;
  EXPECT_FALSE(drive.at({0.0, -8.0}, 0.1, 22.0));
  EXPECT_FALSE(drive.at({0.0, -1.0}, 0.1, 29.0));  // on the way in
  EXPECT_FALSE(drive.at({0.0, 0.0}, 0.0, 30.0));   // the stop
  EXPECT_FALSE(drive.at({0.0, -1.0}, -0.1, 29.0));
  EXPECT_FALSE(drive.at({0.0, -14.0}, -0.1, 16.0));
  EXPECT_FALSE(drive.at({1.0, -1.0 + kCreep}, 0.1, 29.0));
  EXPECT_FALSE(drive.at({1.0, kCreep + kFarther}, 0.0, 30.0 + kFarther));
  EXPECT_FALSE(drive.at({1.0, -2.0 + kCreep}, -0.1, 28.0));
  const auto told = drive.at({1.0, -8.0 + kCreep}, -0.1, 22.0);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->operation, 1);
  EXPECT_TRUE(told->creep.usable);
  EXPECT_NEAR(told->creep.value, kCreep, 0.005);
  EXPECT_NEAR(told->creep.advance, 1.0, 0.01);
  EXPECT_LT(std::abs(told->creep.value - kCreep), 4.0 * told->creep.sigma);
  EXPECT_GT(told->weak_share, 0.02);
  EXPECT_EQ(drive.watch.creeps().size(), 1U);
}

TEST(CreepWatch, TellsNothingOfAPassThatDoesNotComeBack) {
  Drive drive;
  EXPECT_FALSE(drive.at({0.0, 0.0}, 0.0, 30.0));
  EXPECT_FALSE(drive.at({0.0, -12.0}, -0.1, 18.0));
  EXPECT_FALSE(drive.at({0.0, -18.0}, -0.1, 12.0));  // nearer to end 1
  EXPECT_FALSE(drive.at({1.0, -8.0}, 0.1, 22.0));
  EXPECT_FALSE(drive.at({1.0, 0.0}, 0.0, 30.0));
  EXPECT_FALSE(drive.at({1.0, -8.0}, -0.1, 22.0));
  EXPECT_TRUE(drive.watch.creeps().empty());
}

}  // namespace pos::estimation
