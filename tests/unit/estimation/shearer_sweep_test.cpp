/// Whole sweeps into `shearer`: the legs in them are found and used.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "pos/core/angle.hpp"
#include "pos/estimation/shearer.hpp"

namespace pos::estimation {
namespace {

/// Standing at station 100 on an Earth that stands still; legs every 1.5 m, 4 m to the left.
ShearerConfig standing() {
  ShearerConfig config;
  config.earth = ShearerConfig::Earth::Flat;
  config.start.pose = {0.0, 100.0, 0.5 * kPi};
  config.selection.distance = 3.0;
  return config;
}

/// A sweep over round legs of 0.30 m, all of them shifted by `shift` along the face.
Scan2D sweep(double shift) {
  Scan2D scan{.angle_step = kPi / 720.0, .range_max = 15.0};
  for (int beam = 0; beam < 721; ++beam) {
    const Eigen::Vector2d look(std::cos(beam * scan.angle_step), std::sin(beam * scan.angle_step));
    double range = 0.0;
    for (int leg = -8; leg <= 8; ++leg) {
      const Eigen::Vector2d centre(1.5 * leg + 0.5 + shift, 4.0);
      const double along = look.dot(centre);
      const double root = along * along - centre.squaredNorm() + 0.15 * 0.15;
      if (root < 0.0) continue;
      const double here = along - std::sqrt(root);
      if (range == 0.0 || here < range) range = here;
    }
    scan.ranges.push_back(static_cast<float>(range));
    scan.valid.push_back(range > 0.0 ? 1 : 0);
  }
  return scan;
}

Measurement at(double t, Reading reading, const std::string& sensor) {
  return {.stamp = stampFromSeconds(t), .sensor = sensor, .reading = std::move(reading)};
}

/// A shearer that has heard its inertial unit until `t`.
struct Scene {
  Shearer shearer{standing(), std::make_shared<map::TunnelMap>()};
  double t = 0.0;

  Scene() { wait(0.04); }
  void wait(double seconds) {
    for (const double end = t + seconds - 1e-9; t < end; t += 0.01) {
      (void)shearer.ingest(at(t, ImuSample{.linear = {0.0, 0.0, 9.80665}}, "imu"));
    }
  }
  IngestReport see(const Scan2D& scan) { return shearer.ingest(at(t, scan, "lidar")); }
};

}  // namespace

TEST(ShearerSweeps, FirstSweepTakesLegsUpAndTheNextUsesThem) {
  Scene scene;
  const IngestReport first = scene.see(sweep(0.0));
  EXPECT_EQ(first.verdict, Verdict::Applied) << first.reason;
  EXPECT_EQ(first.dof, 0);
  scene.wait(0.04);
  const IngestReport second = scene.see(sweep(0.0));
  EXPECT_EQ(second.verdict, Verdict::Applied) << second.reason;
  EXPECT_GE(second.dof, 3);
  EXPECT_EQ(second.dof % 3, 0);
  EXPECT_LT(second.nis, 0.1 * second.dof);  // no noise
}

TEST(ShearerSweeps, LegsThatMoveAreNotBelieved) {
  Scene scene;
  (void)scene.see(sweep(0.0));
  scene.wait(0.04);
  const IngestReport moved = scene.see(sweep(0.3));
  EXPECT_EQ(moved.verdict, Verdict::Gated);
}

TEST(ShearerSweeps, DustIsToldAndChangesNothing) {
  Scene scene;
  (void)scene.see(sweep(0.0));
  scene.wait(0.04);
  const auto before = scene.shearer.estimateAt(stampFromSeconds(scene.t));
  Scan2D dust = sweep(0.0);
  dust.valid.assign(dust.valid.size(), 0);
  const IngestReport report = scene.see(dust);
  EXPECT_EQ(report.verdict, Verdict::Degenerate);
  EXPECT_EQ(report.reason, "no beam of the sweep came back");
  const auto after = scene.shearer.estimateAt(stampFromSeconds(scene.t));
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->T_map_body.translation, after->T_map_body.translation);
  EXPECT_EQ(before->covariance, after->covariance);
}

TEST(ShearerSweeps, BeforeTheInertialUnitNothingIsTaken) {
  Shearer shearer(standing(), std::make_shared<map::TunnelMap>());
  EXPECT_EQ(shearer.ingest(at(0.0, sweep(0.0), "lidar")).verdict, Verdict::NotInitialised);
}

}  // namespace pos::estimation
