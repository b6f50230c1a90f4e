#include "pos/estimation/wheel_reckoning.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/angle.hpp"
#include "support/manifold_laws.hpp"
#include "support/numeric_jacobian.hpp"
#include "support/small_run.hpp"

namespace pos {

using estimation::GyroWheel;
using estimation::WheelHeading;

namespace {

WheelHeading headingSample(double yaw, double climb) {
  return {.p_map = {3.0, -2.0, 1.0},
          .climb = climb,
          .roll = 0.07,
          .yaw = yaw,
          .yaw_bias = 0.02,
          .track_error = 0.03};
}

GyroWheel gyroSample(const ins::Earth& earth, double yaw) {
  GyroWheel x;
  x.earth = earth;
  x.q_n_b = Pose3::fromXyzYawPitchRoll(0, 0, 0, yaw, -0.1, 0.05).rotation;
  x.gyro_bias = {1e-3, -2e-3, 5e-4};
  x.coordinates = earth.isFlat() ? Eigen::Vector3d(4, 5, 1) : Eigen::Vector3d(1.9, 0.61, -350.0);
  x.scale = 0.01;
  return x;
}

}  // namespace

template <>
struct ManifoldSamples<WheelHeading> {
  static std::vector<WheelHeading> states() {
    return {WheelHeading{}, headingSample(3.1, 0.1), headingSample(-3.1, -0.2)};
  }
};
INSTANTIATE_TYPED_TEST_SUITE_P(WheelHeading, ManifoldLaws, ::testing::Types<WheelHeading>);

template <>
struct ManifoldSamples<GyroWheel> {
  static std::vector<GyroWheel> states() {
    return {GyroWheel{}, gyroSample(ins::Earth::flat(), 3.1), gyroSample(ins::Earth::flat(), -1.0)};
  }
};
INSTANTIATE_TYPED_TEST_SUITE_P(GyroWheel, ManifoldLaws, ::testing::Types<GyroWheel>);

namespace estimation {
namespace {

using testing::imuAt;
using testing::numericJacobian;
using testing::runStamp;
using testing::smallMap;
using testing::smallRun;
using testing::truthAt;

const ins::OdometerConfig kWheels{.wheel_radius = 0.05, .track = 0.2, .ticks_per_turn = 4000};
const std::vector<ins::WheelWay> kWays{{0.01, 0.012}, {0.3, 0.1}, {-0.02, 0.02}, {0.0, 0.0}, {0.5, 0.5}};

TEST(WheelHeadingModels, EveryColumnOfFAndOfTheNoiseGainIsTheDerivative) {
  for (const double yaw : {0.0, 1.2, 3.1415, -3.1415, -2.0}) {
    for (const double climb : {0.0, 0.12, -0.3}) {
      const WheelHeading x = headingSample(yaw, climb);
      for (const ins::WheelWay& way : kWays) {
        const auto step = driven(x, way, 0.02, kWheels, {}, 0.0);
        const Eigen::MatrixXd F = numericJacobian(x, 8, [&](const WheelHeading& y) -> Eigen::VectorXd {
          return minus(driven(y, way, 0.02, kWheels, {}, 0.0).next, step.next);
        });
        EXPECT_LT((step.F - F).cwiseAbs().maxCoeff(), 1e-8) << step.F << "\n\n" << F;
        Matrix<8, 2> G;
        for (int wheel = 0; wheel < 2; ++wheel) {
          const double h = 1e-6;
          const auto at = [&](double d) {
            const ins::WheelWay shifted{way.left + (wheel == 0 ? d : 0.0),
                                        way.right + (wheel == 1 ? d : 0.0)};
            return driven(x, shifted, 0.02, kWheels, {}, 0.0).next;
          };
          G.col(wheel) = minus(at(h), at(-h)) / (2.0 * h);
        }
        EXPECT_LT((wayGain(x, way, kWheels.track) - G).cwiseAbs().maxCoeff(), 1e-8);
      }
    }
  }
}

TEST(WheelHeadingModels, TheAttitudeSeenHasItsJacobianAcrossTheSeam) {
  for (const double yaw : {0.0, 3.1415, -3.1415}) {
    const WheelHeading x = headingSample(yaw, 0.1);
    const SeenAttitude seen{0.08, 0.05, wrapAngle(yaw + 0.04)};
    const auto analytic = attitudeSeen(x, seen);
    EXPECT_LT(std::abs(analytic.nu[2]), 0.1) << "wrapped";
    const Eigen::MatrixXd numeric = numericJacobian(
        x, 8, [&](const WheelHeading& y) -> Eigen::VectorXd { return -attitudeSeen(y, seen).nu; });
    EXPECT_LT((analytic.H - numeric).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(WheelHeadingModels, SeenAttitudeIsTheStatesOwnAndItsCovarianceIsInTheBodysAxes) {
  const WheelHeading x = headingSample(2.2, 0.15);
  const SeenAttitude seen = seenAttitude(x.rotation().toRotationMatrix());
  EXPECT_NEAR(seen.climb, x.climb, 1e-12);
  EXPECT_NEAR(seen.roll, x.roll, 1e-12);
  EXPECT_NEAR(seen.yaw, x.yaw, 1e-12);
  const Matrix<8, 8> A = Matrix<8, 8>::Random();
  const Belief<WheelHeading> belief{x, A * A.transpose()};
  const Eigen::MatrixXd J = numericJacobian(x, 8, [&](const WheelHeading& y) -> Eigen::VectorXd {
    return minus(Pose3{y.p_map, y.rotation()}, Pose3{x.p_map, x.rotation()});
  });
  EXPECT_TRUE(poseCovariance(belief).isApprox(J * belief.covariance * J.transpose(), 1e-6));
}

TEST(WheelHeadingModels, AFullCircleOfArcsComesBack) {
  WheelHeading x;
  for (int i = 0; i < 40; ++i)
    x = driven(x, {0.9 * kPi / 20.0, 1.1 * kPi / 20.0}, 0.1, kWheels, {}, 0.0).next;
  // 40 arcs of 0.0314 / 0.2 rad each turn by 2 pi.
  EXPECT_LT(x.p_map.norm(), 1e-12 * 2.0 * kPi * 10.0);
  EXPECT_NEAR(x.yaw, 0.0, 1e-12);
}

/// A short interval of turning and rolling, and the one that F describes.
TEST(GyroWheelModels, FIsTheDerivativeOfTurningAndRolling) {
  for (const ins::Earth& earth : {ins::Earth::flat(), ins::Earth::ellipsoid()}) {
    for (const double yaw : {0.0, 1.1, 3.1415, -2.4}) {
      const GyroWheel x = gyroSample(earth, yaw);
      const double dt = 1e-3;
      const double raw_way = 3.0 * dt * (1.0 + x.scale);
      const Eigen::Vector3d raw_angle = dt * Eigen::Vector3d(0.02, -0.01, 0.3);
      const auto later = [&](const GyroWheel& y) {
        const Eigen::Vector3d v = 3.0 * (y.q_n_b * Eigen::Vector3d::UnitX());
        const GyroWheel t = turned(y, {raw_angle - dt * y.gyro_bias, Eigen::Vector3d::Zero(), dt}, v);
        return rolled(t, y.q_n_b, t.q_n_b, raw_way / (1.0 + y.scale));
      };
      const GyroWheel next = later(x);
      const Eigen::MatrixXd numeric = numericJacobian<GyroWheel>(
          x, 10, [&](const GyroWheel& y) -> Eigen::VectorXd { return minus(later(y), next); }, 1e-5);
      const Matrix<10, 10> F = gyroWheelF(x, 3.0 * (x.q_n_b * Eigen::Vector3d::UnitX()));
      const Matrix<10, 10> Phi = Matrix<10, 10>::Identity() + dt * F;
      // Rounding of 1e-5 m in longitudes, and the second order in dt.
      EXPECT_LT((Phi - numeric).cwiseAbs().maxCoeff(), earth.isFlat() ? 2e-6 : 1e-3) << Phi - numeric;
      EXPECT_LT((Phi - numeric).leftCols<6>().cwiseAbs().maxCoeff(), 4e-6 + (earth.isFlat() ? 0.0 : 1e-4));
    }
  }
}

TEST(GyroWheelModels, ZeroRateHasItsJacobian) {
  for (const ins::Earth& earth : {ins::Earth::flat(), ins::Earth::ellipsoid()}) {
    const GyroWheel x = gyroSample(earth, 2.0);
    const Eigen::Vector3d seen(0.01, 0.02, 0.03);
    const Eigen::MatrixXd numeric =
        numericJacobian(x, 10, [&](const GyroWheel& y) -> Eigen::VectorXd { return -zeroRate(y, seen).nu; });
    EXPECT_LT((zeroRate(x, seen).H - numeric).cwiseAbs().maxCoeff(), 1e-8);
  }
}

DeadReckoningConfig config(DeadReckoningConfig::Variant variant) {
  DeadReckoningConfig c;
  c.variant = variant;
  c.start.pose = truthAt(0.0);
  c.odometer.track = 1.0;
  return c;
}

/// Noise-free wheels and gyros along the oval.
std::vector<Measurement> exactRun() {
  return smallRun({.distance_noise = 0.0, .lateral_noise = 0.0, .yaw_noise = 0.0, .inertial = true});
}

TEST(WheelReckoning, EveryVariantFollowsExactReadings) {
  using Variant = DeadReckoningConfig::Variant;
  for (const Variant variant : {Variant::Encoders, Variant::EncodersAttitude, Variant::EkfHeading}) {
    WheelReckoning estimator(config(variant), smallMap());
    const auto run = exactRun();
    for (const Measurement& m : run) (void)estimator.ingest(m);
    const auto estimate = estimator.estimateAt(run.back().stamp);
    ASSERT_TRUE(estimate);
    const Pose2 truth = truthAt(seconds(run.back().stamp - runStamp(0.0)));
    // The increments of the run leave out what lies sideways of a chord, and start while it is in motion.
    EXPECT_LT(minus(estimate->T_map_body.planar(), truth).norm(), 0.15) << static_cast<int>(variant);
  }
}

TEST(WheelReckoning, WheelsWithAWrongTrackTurnTheEncodersButNotTheGyros) {
  using Variant = DeadReckoningConfig::Variant;
  const auto run = exactRun();
  const Pose2 truth = truthAt(seconds(run.back().stamp - runStamp(0.0)));
  const auto yawError = [&](DeadReckoningConfig c) {
    c.odometer.track = 1.0;  // the log's wheels are written with the estimator's own track: scale the turns
    WheelReckoning estimator(c, smallMap());
    for (Measurement m : run) {
      if (auto* odometry = std::get_if<OdometryIncrement>(&m.reading)) odometry->increment.yaw *= 0.96;
      (void)estimator.ingest(m);
    }
    return std::abs(wrapAngle(estimator.estimateAt(run.back().stamp)->T_map_body.yaw() - truth.yaw));
  };
  const double encoders = yawError(config(Variant::Encoders));
  const double gyros = yawError(config(Variant::EncodersAttitude));
  DeadReckoningConfig states = config(Variant::EkfHeading);
  states.heading.yaw_sigma = radians(0.1);
  states.heading.correlation_time = 0.0;
  states.heading.yaw_bias = {0.0, radians(0.1), radians(0.02)};
  states.heading.track_error = {0.0, 0.03, 0.0};
  const double fused = yawError(states);
  EXPECT_GT(encoders, 0.15) << "4 % of 6 rad";
  // The run starts in motion: the heading it starts with is up to one wheel reading old, 0.1 s at 0.5 rad/s.
  EXPECT_LT(gyros, 0.05);
  EXPECT_LT(fused, 0.05);
}

TEST(WheelReckoning, StandingStillFindsTheGyroBias) {
  DeadReckoningConfig c = config(DeadReckoningConfig::Variant::EncodersAttitude);
  c.alignment.time = 2.0;
  WheelReckoning estimator(c, smallMap());
  ImuSample still;
  still.angular = {1e-3, -2e-3, 3e-3};
  still.linear = {0.0, 0.0, 9.80665};
  for (int i = 0; i <= 400; ++i) (void)estimator.ingest({runStamp(0.01 * i), "imu", still});
  ASSERT_EQ(estimator.diagnostics()[1].name, "gyro_bias_z_rad_per_s");
  EXPECT_NEAR(estimator.diagnostics()[1].value, 3e-3, 1e-9);
  EXPECT_NEAR(estimator.estimateAt(runStamp(4.0))->T_map_body.yaw(), truthAt(0.0).yaw, 1e-9);
}

TEST(WheelReckoning, EncodersAloneHaveNoUseForAnInertialUnit) {
  WheelReckoning estimator(config(DeadReckoningConfig::Variant::Encoders), smallMap());
  EXPECT_EQ(estimator.ingest({runStamp(0.0), "imu", imuAt(0.0)}).verdict, Verdict::Unsupported);
}

}  // namespace
}  // namespace estimation
}  // namespace pos
