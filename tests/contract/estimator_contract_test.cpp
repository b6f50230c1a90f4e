/// The promises of pos/estimation/estimator.hpp, run over every estimator.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <limits>

#include "pos/yardstick/factory.hpp"
#include "support/small_run.hpp"

namespace pos::estimation {
namespace {

using pos::testing::runStamp;
using pos::testing::smallMap;
using pos::testing::smallRun;
using pos::testing::SmallRunOptions;
using pos::testing::truthAt;

struct Subject {
  std::string name;
  EstimatorConfig config;
  bool uses_scans = false;
  bool two_tags = false;
  bool uses_gyro = false;
  bool inertial = false;
};

const Eigen::Vector3d kFirstTag(0.1, 0.5, 1.0);
const Eigen::Vector3d kSecondTag(0.0, -0.5, 1.0);

std::ostream& operator<<(std::ostream& out, const Subject& subject) {
  return out << subject.name;
}

StartConfig startAtTruth(StartMode mode) {
  StartConfig start;
  start.mode = mode;
  start.pose = truthAt(0.0);
  return start;
}

std::vector<Subject> subjects() {
  DeadReckoningConfig dead_reckoning;
  dead_reckoning.start = startAtTruth(StartMode::Known);
  RangeOdometryConfig known;
  known.start = startAtTruth(StartMode::Known);
  RangeOdometryConfig unknown_heading = known;
  unknown_heading.start.mode = StartMode::UnknownHeading;
  RangeOdometryConfig unknown = known;
  unknown.start.mode = StartMode::Unknown;
  unknown.range_scale.sigma = 0.02;
  unknown.anchor_offset.sigma = 0.05;
  RangeOdometryConfig no_odometry = known;
  no_odometry.motion = RangeOdometryConfig::Motion::ConstantVelocity;
  no_odometry.latency.sigma = 0.05;
  MclConfig mcl;
  mcl.start = startAtTruth(StartMode::Known);
  mcl.particles.min = 200;
  mcl.particles.max = 2000;
  MclConfig mcl_scan = mcl;
  mcl_scan.use_ranges = false;
  mcl_scan.use_scans = true;
  MrptMclConfig mrpt;
  mrpt.start = startAtTruth(StartMode::Known);
  mrpt.particles = 500;
  MrptMclConfig mrpt_scan = mrpt;
  mrpt_scan.use_ranges = false;
  mrpt_scan.use_scans = true;
  DualUwbConfig dual;  // finds its start itself
  dual.range_sigma = 0.1;
  dual.acceleration_density = 1.0;
  dual.yaw_acceleration_density = 1.0;
  DualUwbConfig dual_known = dual;
  dual_known.start = startAtTruth(StartMode::Known);
  DualUwbConfig dual_biases = dual;
  dual_biases.tags = {{0, kFirstTag}, {1, kSecondTag}};
  dual_biases.link_bias = {0.0, 0.05, 0.01};
  dual_biases.motion = DualUwbConfig::Motion::Free;
  DualUwbConfig dual_gyro = dual;
  dual_gyro.variant = DualUwbConfig::Variant::FilterGyro;
  DualUwbConfig snapshot = dual;
  snapshot.variant = DualUwbConfig::Variant::Snapshot;
  DualUwbConfig differential = dual_known;
  differential.variant = DualUwbConfig::Variant::Differential;
  DualUwbConfig rigid = dual;
  rigid.variant = DualUwbConfig::Variant::Rigid;
  SinsDrConfig sins;  // the run starts in motion: it has to level itself on the way
  sins.start = startAtTruth(StartMode::Known);
  sins.odometer.track = 1.0;
  DeadReckoningConfig encoders = dead_reckoning;
  encoders.variant = DeadReckoningConfig::Variant::Encoders;
  encoders.odometer.track = 1.0;
  DeadReckoningConfig attitude = encoders;
  attitude.variant = DeadReckoningConfig::Variant::EncodersAttitude;
  DeadReckoningConfig ekf_heading = encoders;
  ekf_heading.variant = DeadReckoningConfig::Variant::EkfHeading;
  DeadReckoningConfig ekf_states = ekf_heading;
  ekf_states.heading.yaw_bias = {0.0, 0.001, 0.001};
  ekf_states.heading.track_error = {0.0, 0.02, 0.0};
  UwbImuConfig eskf;  // likewise
  eskf.start = startAtTruth(StartMode::Known);
  eskf.first = {InertialStart::Levelling::InMotion, 0.5, 0.5, 0.02, 0.05};
  eskf.aids.height_sigma = 0.05;
  UwbImuConfig eskf_biases = eskf;
  eskf_biases.anchor_bias.sigma = 0.3;
  eskf_biases.anchor_bias.after = 0.2;
  eskf_biases.robust.form = filters::RobustConfig::Form::Igg3;
  UwbImuConfig eskf_late = eskf;
  eskf_late.lag = 0.5;
  UwbImuConfig ekf = eskf;
  ekf.variant = UwbImuConfig::Variant::Ekf;
  UwbImuConfig ukf = eskf;
  ukf.variant = UwbImuConfig::Variant::Ukf;
  UwbImuConfig uwb_only = eskf;  // one anchor at a time: an epoch is a round of all
  uwb_only.variant = UwbImuConfig::Variant::UwbOnly;
  uwb_only.epoch_span = 0.45;
  uwb_only.max_speed = 2.0;
  SeamlessConfig imm;
  imm.start = startAtTruth(StartMode::Known);
  imm.variant = SeamlessConfig::Variant::Imm;
  imm.aids = {.side_slip_sigma = 0.1, .floor_sigma = 0.1};
  SeamlessConfig faimm = imm;
  faimm.variant = SeamlessConfig::Variant::Faimm;
  faimm.imm.likelihood = filters::LikelihoodForm::PositionDomain;
  ShearerConfig shearer;  // no legs in this room: the inertial unit alone, told how fast it goes at the start
  shearer.earth = ShearerConfig::Earth::Flat;
  shearer.start = startAtTruth(StartMode::Known);
  shearer.alignment.speed = 0.5;
  ShearerConfig shearer_states = shearer;
  shearer_states.selection.mode = 0;
  shearer_states.scanner.use = true;
  shearer_states.picm.use = PicmConfig::Use::Continue;
  ShearerConfig shearer_dr = shearer;
  shearer_dr.variant = ShearerConfig::Variant::Dr;
  ShearerConfig shearer_closed = shearer;
  shearer_closed.variant = ShearerConfig::Variant::DrClosedPath;
  return {{"seamless_imm", imm, false, false, false, true},
          {"seamless_faimm", faimm, false, false, false, true},
          {"uwb_imu_eskf", eskf, false, false, false, true},
          {"uwb_imu_eskf_biases", eskf_biases, false, false, false, true},
          {"uwb_imu_eskf_late", eskf_late, false, false, false, true},
          {"uwb_imu_ekf", ekf, false, false, false, true},
          {"uwb_imu_ukf", ukf, false, false, false, true},
          {"uwb_imu_uwb_only", uwb_only},
          {"sins_dr", sins, false, false, false, true},
          {"shearer", shearer, false, false, false, true},
          {"shearer_states", shearer_states, false, false, false, true},
          {"shearer_dr", shearer_dr, false, false, false, true},
          {"shearer_dr_closed_path", shearer_closed, false, false, false, true},
          {"dead_reckoning_encoders", encoders},
          {"dead_reckoning_encoders_attitude", attitude, false, false, false, true},
          {"dead_reckoning_ekf_heading", ekf_heading, false, false, false, true},
          {"dead_reckoning_ekf_heading_states", ekf_states, false, false, false, true},
          {"dual_uwb_filter", dual, false, true},
          {"dual_uwb_filter_known", dual_known, false, true},
          {"dual_uwb_filter_biases", dual_biases, false, true},
          {"dual_uwb_filter_gyro", dual_gyro, false, true, true},
          {"dual_uwb_snapshot", snapshot, false, true},
          {"dual_uwb_differential", differential, false, true},
          {"dual_uwb_rigid", rigid, false, true},
          {"dead_reckoning", dead_reckoning},
          {"range_odometry", known},
          {"range_odometry_unknown_heading", unknown_heading},
          {"range_odometry_unknown", unknown},
          {"range_odometry_constant_velocity", no_odometry},
          {"mcl_ranges", mcl},
          {"mcl_scan", mcl_scan, true},
          {"mrpt_mcl_ranges", mrpt},
          {"mrpt_mcl_scan", mrpt_scan, true}};
}

class EveryEstimator : public ::testing::TestWithParam<Subject> {
 protected:
  std::unique_ptr<Estimator> make() const {
    return yardstick::makeAnyEstimator(GetParam().config, smallMap());
  }
  std::vector<Measurement> log(double duration = 6.0) const {
    SmallRunOptions options{.duration = duration,
                            .scans = GetParam().uses_scans,
                            .gyro = GetParam().uses_gyro,
                            .inertial = GetParam().inertial};
    if (GetParam().two_tags) {
      options.tag_body = kFirstTag;
      options.second_tag = kSecondTag;
    }
    return smallRun(options);
  }
};

bool sameBits(const Estimate& a, const Estimate& b) {
  return a.stamp == b.stamp && a.T_map_body.translation == b.T_map_body.translation &&
         a.T_map_body.rotation.coeffs() == b.T_map_body.rotation.coeffs() && a.covariance == b.covariance &&
         a.twist.has_value() == b.twist.has_value() &&
         (!a.twist || (a.twist->rates == b.twist->rates && a.twist->covariance == b.twist->covariance));
}

bool sameBits(const std::optional<Estimate>& a, const std::optional<Estimate>& b) {
  return a.has_value() == b.has_value() && (!a || sameBits(*a, *b));
}

void expectSound(const Estimate& estimate) {
  const Matrix<6, 6>& P = estimate.covariance;
  ASSERT_TRUE(P.allFinite());
  ASSERT_TRUE(estimate.T_map_body.translation.allFinite());
  EXPECT_LE((P - P.transpose()).norm(), 1e-9 * (1.0 + P.norm()));
  const double least = Eigen::SelfAdjointEigenSolver<Matrix<6, 6>>(P).eigenvalues().minCoeff();
  EXPECT_GE(least, -1e-9 * (1.0 + P.norm()));
  if (!estimate.twist) return;
  const Matrix<3, 3>& V = estimate.twist->covariance;
  ASSERT_TRUE(V.allFinite() && estimate.twist->rates.allFinite());
  const double least_rate = Eigen::SelfAdjointEigenSolver<Matrix<3, 3>>(V).eigenvalues().minCoeff();
  EXPECT_GE(least_rate, -1e-9 * (1.0 + V.norm()));
}

std::vector<Measurement> oddities() {
  const auto nan = std::numeric_limits<double>::quiet_NaN();
  BeaconRange negative;
  negative.range = -1.0;
  BeaconRange not_a_number;
  not_a_number.range = nan;
  BeaconRange stranger;
  stranger.anchor = 999;
  stranger.range = 5.0;
  OdometryIncrement broken;
  broken.increment.yaw = nan;
  ImuSample imu;
  return {{runStamp(7.0), "uwb", negative},       {runStamp(7.0), "uwb", not_a_number},
          {runStamp(7.0), "uwb", stranger},       {runStamp(7.0), "wheels", broken},
          {runStamp(7.0), "laser", Scan2D{}},     {runStamp(7.0), "imu", imu},
          {runStamp(7.0), "ticks", WheelTicks{}}, {runStamp(7.0), "truth", PoseTruth{}}};
}

}  // namespace

TEST_P(EveryEstimator, SameInputGivesBitSameOutput) {
  const auto first = make();
  const auto second = make();
  for (const Measurement& m : log()) {
    const IngestReport a = first->ingest(m);
    const IngestReport b = second->ingest(m);
    ASSERT_EQ(a.verdict, b.verdict);
    ASSERT_TRUE(sameBits(first->estimateAt(m.stamp), second->estimateAt(m.stamp)));
  }
}

TEST_P(EveryEstimator, CovarianceStaysFiniteSymmetricAndPositive) {
  const auto estimator = make();
  bool answered = false;
  for (const Measurement& m : log(12.0)) {
    (void)estimator->ingest(m);
    if (const auto estimate = estimator->estimateAt(m.stamp)) {
      expectSound(*estimate);
      answered = true;
    }
  }
  EXPECT_TRUE(answered);
}

TEST_P(EveryEstimator, AskingChangesNothing) {
  const auto asked = make();
  const auto quiet = make();
  const auto run = log();
  for (const Measurement& m : run) {
    (void)asked->ingest(m);
    (void)quiet->ingest(m);
    for (const double ahead : {0.0, 0.05, 3.0}) (void)asked->estimateAt(m.stamp + durationFromSeconds(ahead));
    (void)asked->diagnostics();
  }
  EXPECT_TRUE(sameBits(asked->estimateAt(run.back().stamp), quiet->estimateAt(run.back().stamp)));
}

TEST_P(EveryEstimator, StrangeReadingsGetAVerdictAndChangeNothing) {
  const auto estimator = make();
  for (const Measurement& m : log()) (void)estimator->ingest(m);
  const auto before = estimator->estimateAt(runStamp(7.0));
  for (const Measurement& odd : oddities()) {
    if (GetParam().uses_gyro && std::holds_alternative<ImuSample>(odd.reading)) continue;  // not odd to it
    const IngestReport report = estimator->ingest(odd);
    EXPECT_NE(report.verdict, Verdict::Applied) << readingName(odd.reading);
    EXPECT_FALSE(report.reason.empty()) << readingName(odd.reading);
    EXPECT_TRUE(sameBits(before, estimator->estimateAt(runStamp(7.0)))) << readingName(odd.reading);
  }
}

TEST_P(EveryEstimator, OlderThanTheStateIsTooOldAndChangesNothing) {
  const auto estimator = make();
  const auto run = log();
  for (const Measurement& m : run) (void)estimator->ingest(m);
  const auto before = estimator->estimateAt(run.back().stamp);
  Measurement old = run[2];
  old.stamp = runStamp(-1.0);
  EXPECT_EQ(estimator->ingest(old).verdict, Verdict::TooOld);
  EXPECT_TRUE(sameBits(before, estimator->estimateAt(run.back().stamp)));
}

TEST_P(EveryEstimator, EqualStampsAndZeroIncrementsAreLegal) {
  const auto estimator = make();
  const auto run = log();
  for (const Measurement& m : run) (void)estimator->ingest(m);
  const auto before = estimator->estimateAt(run.back().stamp);
  OdometryIncrement still;
  still.interval = Duration{0};
  const IngestReport report = estimator->ingest({run.back().stamp, "wheels", still});
  EXPECT_NE(report.verdict, Verdict::TooOld);
  const auto after = estimator->estimateAt(run.back().stamp);
  ASSERT_EQ(before.has_value(), after.has_value());
  if (before) {
    EXPECT_LT((before->T_map_body.translation - after->T_map_body.translation).norm(), 0.25);
  }
}

TEST_P(EveryEstimator, AnswersNothingBeforeTheFirstMeasurement) {
  EXPECT_FALSE(make()->estimateAt(runStamp(0.0)));
}

TEST_P(EveryEstimator, UncertaintyDoesNotShrinkWhileNothingIsHeard) {
  const auto estimator = make();
  const auto run = log();
  for (const Measurement& m : run) (void)estimator->ingest(m);
  const auto now = estimator->estimateAt(run.back().stamp);
  const auto later = estimator->estimateAt(run.back().stamp + durationFromSeconds(5.0));
  ASSERT_TRUE(now && later);
  EXPECT_GE(later->planarCovariance().trace(), now->planarCovariance().trace() * (1.0 - 1e-9));
}

TEST_P(EveryEstimator, ResetStartsOverFromThePrior) {
  const auto estimator = make();
  for (const Measurement& m : log()) (void)estimator->ingest(m);
  const Belief<Pose2> prior{{3.0, 4.0, 0.5}, Vector<3>(0.01, 0.01, 0.001).asDiagonal()};
  estimator->reset(runStamp(100.0), prior);
  const auto estimate = estimator->estimateAt(runStamp(100.0));
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->T_map_body.translation.x(), 3.0, 0.05);
  EXPECT_NEAR(estimate->T_map_body.translation.y(), 4.0, 0.05);
  EXPECT_NEAR(estimate->T_map_body.yaw(), 0.5, 0.05);
}

TEST_P(EveryEstimator, FollowsTheTruthOnAnEasyRun) {
  const auto estimator = make();
  const auto run = log(20.0);
  for (const Measurement& m : run) (void)estimator->ingest(m);
  const auto estimate = estimator->estimateAt(run.back().stamp);
  ASSERT_TRUE(estimate);
  const Pose2 truth = truthAt(seconds(run.back().stamp - runStamp(0.0)));
  EXPECT_LT((estimate->T_map_body.translation.head<2>() - truth.translation()).norm(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Contract, EveryEstimator, ::testing::ValuesIn(subjects()),
                         [](const auto& named) { return named.param.name; });

}  // namespace pos::estimation
