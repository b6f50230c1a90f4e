// The shearer's filter on a short face: the theory of its errors (spec B, B6.1), and its honesty over runs.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "pos/core/chi_square.hpp"
#include "pos/core/random.hpp"
#include "support/shearer_runs.hpp"

namespace pos::estimation {
namespace {

using testing::ShearerScene;
using testing::ShearerSceneOptions;

constexpr double kFace = 45.0;   // m: thirty supports
constexpr double kPass = 460.0;  // s

ShearerSceneOptions shortFace(int passes) {
  ShearerSceneOptions options;
  options.motion = {
      .passes = passes, .pass_length = kFace, .pass_time = kPass, .dwell_time = 400.0, .excursion = 36.0};
  options.inertial_errors = options.scanner_errors = false;
  return options;
}

ShearerConfig shortConfig(const SelectionConfig& selection) {
  ShearerConfig config = testing::shearerConfig(Eigen::Vector3d::Zero());
  config.face.length = kFace;
  config.selection = selection;
  return config;
}

/// Errors (east, north, up) at the end of each pass.
std::vector<Eigen::Vector3d> errorsAtEnds(const ShearerSceneOptions& options, const ShearerConfig& config) {
  const ShearerScene scene = testing::shearerScene(options);
  Shearer shearer(config, scene.map);
  std::vector<Eigen::Vector3d> errors;
  const double cycle = options.motion.pass_time + options.motion.dwell_time;
  testing::runShearer(scene, 1, {&shearer}, [&](double t, const Pose3& truth) {
    if (std::abs(std::fmod(t, cycle) - (kPass - 2.0)) > 0.5) return;
    const auto estimate = shearer.estimateAt(stampFromSeconds(1000.0 + t));
    ASSERT_TRUE(estimate);
    errors.push_back(estimate->T_map_body.translation - truth.translation);
  });
  return errors;
}

/// The scanner's share of the error over a pass: spec B, B6.1.
Eigen::Vector2d theory(double d, bool zone_a) {
  const sim::LidarErrors e = sim::LidarErrors::paper();
  const auto seen = [&](double along) -> Eigen::Vector2d {
    const double angle = sim::measuredAngle(std::atan2(4.0, along), e);
    const double range = sim::measuredRange(std::hypot(4.0, along), e);
    return {-range * std::sin(angle), range * std::cos(angle)};
  };
  const double first = zone_a ? d + 1.5 : -d;
  const Eigen::Vector2d travelled = seen(first) - seen(first - 1.5);
  return kFace / 1.5 * (travelled - Eigen::Vector2d(0.0, 1.5));
}

}  // namespace

TEST(ShearerTheory, WithoutErrorsTheTruthIsFollowed) {
  for (const auto& error :
       errorsAtEnds(shortFace(3), shortConfig({.mode = 2, .features = 1, .distance = 9.0})))
    EXPECT_LT(error.norm(), 1e-4);
}

TEST(ShearerTheory, ScannerErrorsCostWhatTheTheorySays) {
  ShearerSceneOptions options = shortFace(1);
  options.scanner_errors = true;
  for (const double d : {3.0, 7.5, 9.0}) {
    const auto errors = errorsAtEnds(options, shortConfig({.mode = 2, .features = 1, .distance = d}));
    ASSERT_EQ(errors.size(), 1U);
    std::printf("d %.1f: E %.4f N %.4f, theory %.4f %.4f\n", d, errors[0].x(), errors[0].y(),
                theory(d, false).x(), theory(d, false).y());
    // The first and the last support are not driven past in full: a 30th of the way each.
    EXPECT_NEAR(errors[0].x(), theory(d, false).x(), 0.12 * std::abs(theory(d, false).x()));
    EXPECT_NEAR(errors[0].y(), theory(d, false).y(), 0.04 * std::abs(theory(d, false).y()) + 1e-3);
  }
}

TEST(ShearerTheory, TheWayBackCancelsInModes2And7Only) {
  ShearerSceneOptions options = shortFace(2);
  options.scanner_errors = true;
  for (const int mode : {2, 7}) {
    const auto errors = errorsAtEnds(options, shortConfig({.mode = mode, .features = 1, .distance = 7.5}));
    ASSERT_EQ(errors.size(), 2U);
    std::printf("mode %d: N %.4f there, %.4f back\n", mode, errors[0].y(), errors[1].y());
    // The first and the last support are not driven past in full, at either end.
    EXPECT_LT(std::abs(errors[1].y()), 0.07 * std::abs(errors[0].y()) + 0.002) << mode;
  }
  const auto errors = errorsAtEnds(options, shortConfig({.mode = 1, .features = 1, .distance = 7.5}));
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_GT(std::abs(errors[1].y()), 0.05);
}

namespace {

constexpr double kPhiYaw = -15.6;   // arc minutes, of the alignment
constexpr double kBetaYaw = 15.3;   // of the unit's mount as calibrated
constexpr double kAlphaYaw = 13.8;  // of the scanner's mount

/// What a first pass with the paper's mount errors comes to under a use of PICM.
struct PicmPass {
  Eigen::Vector3d error;
  double eta;
};
PicmPass picmPass(PicmConfig::Use use, double alpha_yaw) {
  ShearerSceneOptions options = shortFace(2);  // it stands only before an end operation
  options.scanner_errors = true;
  options.mount_error = testing::flu(-0.6, 0.0, alpha_yaw);
  const ShearerScene scene = testing::shearerScene(options);
  ShearerConfig config = testing::shearerConfig(testing::arcmin(-0.23, 0.24, kPhiYaw), 0.05);
  config.face.length = kFace;
  config.selection = {.mode = 2, .features = 1, .distance = 7.5};
  config.picm = {.use = use, .body_mount = testing::flu(0.0, 0.0, -kBetaYaw)};
  Shearer shearer(config, scene.map);
  PicmPass pass{};
  testing::runShearer(scene, 1, {&shearer}, [&](double t, const Pose3& truth) {
    const auto estimate = shearer.estimateAt(stampFromSeconds(1000.0 + t));
    if (estimate && t > kPass + 3.0 && t < kPass + 8.0)
      pass.error = estimate->T_map_body.translation - truth.translation;
  });
  for (const NamedValue& value : shearer.diagnostics()) {
    if (value.name == "picm_angle_rad") pass.eta = value.value;
  }
  return pass;
}

}  // namespace

// Property 16 of spec C3. A prior of 0.05 arc minutes holds yaw where it is, as the formulas have it.
TEST(ShearerPicm, DrivesEastToWhatYawAndMountOfTheUnitLeave) {
  using Use = PicmConfig::Use;
  const PicmPass off = picmPass(Use::Off, kAlphaYaw);
  const PicmPass restart = picmPass(Use::Restart, kAlphaYaw);
  const PicmPass onward = picmPass(Use::Continue, kAlphaYaw);
  const double left = radians((kPhiYaw + kBetaYaw) / 60.0) * kFace;
  std::printf("east: off %.4f, restart %.4f, continue %.4f, predicted %.4f; eta %.4f'\n", off.error.x(),
              restart.error.x(), onward.error.x(), left, degrees(60.0 * restart.eta));
  EXPECT_NEAR(restart.error.x(), left, 0.002);
  EXPECT_NEAR(onward.error.x(), left, 0.003);
  EXPECT_GT(std::abs(off.error.x()), 3.0 * std::abs(restart.error.x()));
  EXPECT_NEAR(restart.eta, (off.error.x() - left) / kFace, 0.003 / kFace);
  EXPECT_NEAR(restart.error.y(), off.error.y(), 0.001);
  EXPECT_NEAR(restart.error.z(), off.error.z(), 0.001);
}

TEST(ShearerPicm, ASecondTimeItFindsNothing) {
  const PicmPass first = picmPass(PicmConfig::Use::Restart, kAlphaYaw);
  const PicmPass second = picmPass(PicmConfig::Use::Restart, kAlphaYaw - degrees(60.0 * first.eta));
  EXPECT_LT(std::abs(second.eta), 0.02 * std::abs(first.eta));
}

namespace {

/// Runs with errors drawn from what the filter is told: the sum of NEES over attitude, velocity and position.
double neesOfRuns(int runs, Initialisation how) {
  double sum = 0.0;
  for (int run = 0; run < runs; ++run) {
    ShearerSceneOptions options = shortFace(1);
    options.lidar_rate = 5.0;
    ShearerScene scene = testing::shearerScene(options);
    auto& imu = std::get<sim::ImuModel>(scene.scenario.sensors[0].model);
    ShearerConfig config = shortConfig({.mode = 2, .features = 1, .distance = 9.0});
    config.propagation_interval = 0.2;
    imu.errors = {
        .gyro = {.bias_sigma = config.imu.gyro_bias_sigma, .noise_density = config.imu.gyro_density},
        .accelerometer = {.bias_sigma = config.imu.accelerometer_bias_sigma,
                          .noise_density = config.imu.accelerometer_density}};
    RandomStream random(static_cast<std::uint64_t>(run), 77);
    const auto P = shearerStartCovariance(config, {});
    ins::NavigationState nav = shearerStart(config, {});
    Eigen::Vector3d drawn[3];
    for (int block = 0; block < 3; ++block) {
      for (int i = 0; i < 3; ++i)
        drawn[block][i] = random.normal(0.0, std::sqrt(P(3 * block + i, 3 * block + i)));
    }
    nav.q_n_b = quaternionFromRotationVector(drawn[0]) * nav.q_n_b;
    nav.v_n += drawn[1];
    nav.coordinates += drawn[2];
    ShearerFilter filter(config, 2, how);
    filter.start(shearerEarth(config, *scene.map), nav, P);
    sim::Simulation simulation(scene.scenario, scene.map, static_cast<std::uint64_t>(run) + 1);
    const Eigen::Matrix3d R = config.legs.sigma.cwiseAbs2().asDiagonal();
    while (const auto delivery = simulation.next()) {
      const Measurement& m = delivery->measurement;
      if (const auto* sample = std::get_if<ImuSample>(&m.reading))
        (void)filter.step({sample->angular, sample->linear, seconds(*sample->interval)});
      if (const auto* scan = std::get_if<Scan2D>(&m.reading)) {
        Eigen::Vector3d leg = scan->T_body_sensor * Eigen::Vector3d(scan->ranges[0], 0.0, 0.0);
        for (int i = 0; i < 3; ++i) leg[i] += random.normal(0.0, config.legs.sigma[i]);
        (void)filter.see(leg, R, 0.0);
      }
      if (seconds(m.stamp - simulation.start()) > kPass - 5.0) break;
    }
    filter.catchUp();
    const sim::Kinematics truth = simulation.truthAt(kPass - 5.0);
    const ShearerState& x = filter.belief().mean;
    Eigen::Matrix<double, 9, 1> d;
    d.head<3>() = rotationVector(Eigen::Quaterniond(truth.R_map_body) * x.nav.q_n_b.conjugate());
    d.segment<3>(3) = truth.v_map - x.nav.v_n;
    d.tail<3>() = truth.p_map - x.nav.coordinates;
    const Eigen::Matrix<double, 9, 9> P9 = filter.belief().covariance.topLeftCorner<9, 9>();
    sum += d.dot(P9.llt().solve(d));
  }
  return sum;
}

}  // namespace

TEST(ShearerStatistics, NeesIsThatOfAnHonestFilterAndNotSoWithUncorrelatedLegs) {
  constexpr int kRuns = 100;
  const double low = chiSquareQuantile(0.005, 9.0 * kRuns);
  const double high = chiSquareQuantile(0.995, 9.0 * kRuns);
  const double honest = neesOfRuns(kRuns, Initialisation::Correlated);
  const double feigned = neesOfRuns(kRuns, Initialisation::Uncorrelated);
  std::printf("NEES of 9 over %d runs: %.2f, uncorrelated %.2f (%.2f to %.2f)\n", kRuns, honest / kRuns,
              feigned / kRuns, low / kRuns, high / kRuns);
  EXPECT_GT(honest, low);
  EXPECT_LT(honest, high);
  EXPECT_GT(feigned, high);
}

}  // namespace pos::estimation
