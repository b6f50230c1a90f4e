#include <gtest/gtest.h>

#include <cmath>

#include "pos/sim/encoder.hpp"
#include "support/sample_vehicles.hpp"
#include "unit/sim/paper_motions.hpp"
#include "unit/sim/refusals.hpp"

namespace pos::sim {
namespace {

std::vector<Delivery> deliveries(EncoderModel model, const Vehicle& vehicle,
                                 const std::shared_ptr<const Motion>& motion, std::uint64_t seed = 1) {
  model.timing.stream = streamOf(model.sensor);
  const auto stream = makeEncoderStream(model, vehicle, motion, {.seed = seed});
  std::vector<Delivery> all;
  while (auto delivery = stream->next()) all.push_back(*std::move(delivery));
  return all;
}

template <class R>
const R& readingOf(const Delivery& delivery) {
  return std::get<R>(delivery.measurement.reading);
}

double stampOf(const Delivery& delivery) {
  return secondsSinceOrigin(delivery.measurement.stamp);
}

/// Dead reckoning on the increments, in the plane.
Pose2 reckoned(const std::vector<Delivery>& all) {
  Pose2 pose;
  for (const Delivery& delivery : all) pose = pose * readingOf<OdometryIncrement>(delivery).increment;
  return pose;
}

EncoderModel increments(double ticks_per_turn) {
  return {.output = EncoderModel::Output::Increment, .ticks_per_turn = ticks_per_turn};
}

SlipEvent ropeSlip() {
  return {
      .window = {7, 13}, .kind = SlipEvent::Kind::Free, .speed = 0.3, .amplitude = 0.15, .frequency = 1.3};
}

}  // namespace

TEST(Encoders, TicksReproduceThePathLengthToOneTick) {
  const Vehicle car = samples::differential();
  const EncoderModel model{.timing = {.rate = 50}};
  const double tick = 2.0 * kPi * car.wheel_radius / model.ticks_per_turn;
  for (const MotionConfig& config : {MotionConfig(papers::laneShift()), MotionConfig(papers::curve()),
                                     MotionConfig(papers::loop()), MotionConfig(papers::incline())}) {
    const std::shared_ptr<const Motion> motion = makeMotion(config);
    for (const Delivery& delivery : deliveries(model, car, motion)) {
      const auto& ticks = readingOf<WheelTicks>(delivery);
      const double way = 0.5 * tick * static_cast<double>(ticks.left + ticks.right);
      EXPECT_NEAR(way, motion->travelled(stampOf(delivery)), tick);
    }
  }
}

TEST(Encoders, WheelsDifferByTrackTimesTurn) {
  const Vehicle car = samples::differential();
  const std::shared_ptr<const Motion> motion = makeMotion(papers::curve());
  const WheelPair way = rimTravel(*motion, car, {}, 0.0, motion->duration());
  EXPECT_NEAR(way.right - way.left, car.encoder_track * radians(72.8), 1e-12);
  EXPECT_NEAR(0.5 * (way.left + way.right), 6.2, 1e-12);
}

TEST(Encoders, CountersWrapAtTheirWidth) {
  const Vehicle car = samples::differential();
  const std::shared_ptr<const Motion> motion = makeMotion(papers::curve());
  EncoderModel model;
  const auto wide = deliveries(model, car, motion);
  model.counter_bits = 12;
  const auto narrow = deliveries(model, car, motion);
  ASSERT_EQ(wide.size(), narrow.size());
  std::int64_t turns = 0;
  for (std::size_t i = 0; i < wide.size(); ++i) {
    const std::int64_t full = readingOf<WheelTicks>(wide[i]).right;
    EXPECT_EQ(readingOf<WheelTicks>(narrow[i]).right, full % 4096);
    turns = full / 4096;
  }
  EXPECT_GT(turns, 10);
}

TEST(Encoders, BackwardsTheCounterRunsDownThroughItsEnd) {
  const std::shared_ptr<const Motion> motion =
      makeMotion(SegmentMotionConfig{.start = {.speed = -1.0}, .segments = {papers::wait(1)}});
  const auto all = deliveries({.counter_bits = 16}, samples::differential(), motion);
  const double tick = 2.0 * kPi * 0.05 / 4000.0;
  EXPECT_NEAR(static_cast<double>(readingOf<WheelTicks>(all.back()).left - 65536) * tick, -1.0, tick);
}

TEST(Encoders, IncrementsWithoutRoundingLeadToTheEnd) {
  for (const SegmentMotionConfig& config : {papers::curve(), papers::loop(), papers::laneShift()}) {
    const std::shared_ptr<const Motion> motion = makeMotion(config);
    EncoderModel model = increments(0);
    model.timing.rate = 200.0;
    const Pose2 end = reckoned(deliveries(model, samples::differential(), motion));
    const Eigen::Vector3d truth = motion->at(motion->duration()).p_map;
    // An arc a step: error of second order, 0.5 rad/s^2 * speed * dt^2 / 12 a second.
    EXPECT_NEAR(end.x, truth.x(), 2e-5);
    EXPECT_NEAR(end.y, truth.y(), 2e-5);
  }
}

TEST(Encoders, LostIncrementsAreMadeUpForByTheNext) {
  const std::shared_ptr<const Motion> motion = makeMotion(papers::curve());
  EncoderModel model = increments(0);
  std::vector<Delivery> every = deliveries(model, samples::differential(), motion);
  model.timing.drop_probability = 0.4;
  model.timing.outages = {{10, 20}};
  const auto some = deliveries(model, samples::differential(), motion);
  EXPECT_LT(some.size(), 1200U);
  // The very last ones may be among the lost, and nothing comes after them.
  const std::size_t count = every.size();
  while (stampOf(every.back()) > stampOf(some.back())) every.pop_back();
  EXPECT_LT(count - every.size(), 20U);
  const Pose2 all = reckoned(every);
  const Pose2 still = reckoned(some);
  EXPECT_NEAR(still.x, all.x, 1e-12);
  EXPECT_NEAR(still.y, all.y, 1e-12);
  EXPECT_NEAR(still.yaw, all.yaw, 1e-12);
}

TEST(Encoders, TooLargeATrackInTheFileMakesTheHeadingTooSmall) {
  // Paper B, table 1: + 3.78 % of track ends DR-1 at 70.15 instead of 72.8 degrees.
  const std::shared_ptr<const Motion> motion = makeMotion(papers::curve());
  EncoderModel model = increments(4000);
  model.track_error = 0.0378;
  const Pose2 end = reckoned(deliveries(model, samples::differential(), motion));
  EXPECT_NEAR(degrees(end.yaw) - 72.8, -2.65, 0.05);
}

TEST(Encoders, TooLargeARadiusInTheFileMakesTheWayTooLong) {
  const std::shared_ptr<const Motion> motion = makeMotion(papers::laneShift());
  EncoderModel model = increments(0);
  model.left_radius_error = 0.01;
  model.right_radius_error = 0.01;
  double way = 0.0;
  for (const Delivery& d : deliveries(model, samples::frontSteered(), motion))
    way += readingOf<OdometryIncrement>(d).increment.x;
  EXPECT_NEAR(way / motion->travelled(30.0), 1.01, 1e-4);
}

TEST(Encoders, SpeedsAreThoseOfTheWheels) {
  const std::shared_ptr<const Motion> motion = makeMotion(papers::circle());
  const EncoderModel model{
      .output = EncoderModel::Output::Speeds, .timing = {.rate = 20}, .ticks_per_turn = 0};
  const Vehicle car = samples::frontSteered();
  for (const Delivery& delivery : deliveries(model, car, motion)) {
    const auto& speeds = readingOf<WheelSpeeds>(delivery);
    const double rate = stampOf(delivery) <= 10.0 ? 0.0 : 0.1;
    EXPECT_NEAR(speeds.left, 2.0 - 0.5 * car.encoder_track * rate, 1e-9);
    EXPECT_NEAR(speeds.right, 2.0 + 0.5 * car.encoder_track * rate, 1e-9);
  }
}

TEST(Encoders, NoiseOfTheSpeedsHasItsSigma) {
  const std::shared_ptr<const Motion> motion =
      makeMotion(SegmentMotionConfig{.start = {.speed = 2.0}, .segments = {papers::wait(100)}});
  const EncoderModel model{.output = EncoderModel::Output::Speeds,
                           .timing = {.rate = 50},
                           .ticks_per_turn = 0,
                           .speed_sigma = 0.03};
  const auto all = deliveries(model, samples::frontSteered(), motion);
  const auto n = static_cast<double>(all.size());
  double left = 0.0;
  double both = 0.0;
  for (const Delivery& delivery : all) {
    const auto& speeds = readingOf<WheelSpeeds>(delivery);
    left += (speeds.left - 2.0) * (speeds.left - 2.0) / n;
    both += (speeds.left - 2.0) * (speeds.right - 2.0) / n;
  }
  EXPECT_NEAR(left / 9e-4, 1.0, 4.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(both / 9e-4, 0.0, 4.0 / std::sqrt(n));
}

TEST(Encoders, RopeHoldsTheBodyWhileTheWheelsTurn) {
  const std::shared_ptr<const Motion> motion = makeMotion(papers::rope());
  const Vehicle car = samples::differential();
  const WheelPair held = rimTravel(*motion, car, {ropeSlip()}, 7.0, 13.0);
  const double w = 2.0 * kPi * 1.3;
  const double exact = 6.0 * 0.3 + 0.15 * (1.0 - std::cos(w * 6.0)) / w;
  EXPECT_NEAR(held.left, exact, 1e-11);
  EXPECT_NEAR(held.right, exact, 1e-11);
  EXPECT_LT(motion->travelled(13.0) - motion->travelled(7.0), 0.02);
  const WheelPair after = rimTravel(*motion, car, {ropeSlip()}, 13.0, 25.0);
  EXPECT_NEAR(after.left, motion->travelled(25.0) - motion->travelled(13.0), 1e-12);
}

TEST(Encoders, SpinSkidAndLockUpChangeTheRimOnlyInTheirWindow) {
  const std::shared_ptr<const Motion> motion =
      makeMotion(SegmentMotionConfig{.start = {.speed = 2.0}, .segments = {papers::wait(20)}});
  const Vehicle car = samples::frontSteered();
  const std::vector<SlipEvent> slips{{.window = {2.005, 3.0}, .side = SlipEvent::Side::Left, .ratio = 0.3},
                                     {.window = {5, 7}, .kind = SlipEvent::Kind::LockUp},
                                     {.window = {2.5, 3.5}, .side = SlipEvent::Side::Right, .ratio = -0.2}};
  const WheelPair way = rimTravel(*motion, car, slips, 0.0, 20.0);
  // Rounding of the sum of some three thousand parts.
  EXPECT_NEAR(way.left, 40.0 + 0.3 * 2.0 * 0.995 - 4.0, 1e-11);
  EXPECT_NEAR(way.right, 40.0 - 0.2 * 2.0 - 4.0, 1e-11);
}

TEST(Encoders, MicroSlipGrowsWithTheRootOfTheDistance) {
  const std::shared_ptr<const Motion> motion =
      makeMotion(SegmentMotionConfig{.start = {.speed = 5.0}, .segments = {papers::wait(20)}});
  EncoderModel model{.ticks_per_turn = 1e6, .distance_noise = 0.01};
  model.timing.rate = 5.0;
  const double tick = 2.0 * kPi * 0.05 / 1e6;
  constexpr int kRuns = 400;
  double left = 0.0;
  double both = 0.0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const WheelTicks ticks =
        readingOf<WheelTicks>(deliveries(model, samples::differential(), motion, seed).back());
    const double l = static_cast<double>(ticks.left) * tick - 100.0;
    const double r = static_cast<double>(ticks.right) * tick - 100.0;
    left += l * l / kRuns;
    both += l * r / kRuns;
  }
  // Variance 1e-4 * 100 m; relative standard deviation sqrt(2 / n); the wheels do not know of each other.
  EXPECT_NEAR(left / 0.01, 1.0, 4.0 * std::sqrt(2.0 / kRuns));
  EXPECT_NEAR(both / 0.01, 0.0, 4.0 / std::sqrt(kRuns));
}

TEST(Encoders, ClaimedCovarianceIsThatOfTheIncrements) {
  const std::shared_ptr<const Motion> motion =
      makeMotion(SegmentMotionConfig{.start = {.speed = 1.0}, .segments = {papers::turn(0.5, 0.4)}});
  EncoderModel model = increments(0);
  model.timing.rate = 2.0;
  model.distance_noise = 0.02;
  model.yaw_sigma = 0.01;
  model.claims_covariance = true;
  constexpr int kRuns = 2000;
  std::vector<Eigen::Vector3d> tangents;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d claimed;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const OdometryIncrement odometry =
        readingOf<OdometryIncrement>(deliveries(model, samples::frontSteered(), motion, seed).back());
    tangents.emplace_back(odometry.increment.x, odometry.increment.y, odometry.increment.yaw);
    mean += tangents.back() / kRuns;
    if (seed == 0) claimed = *odometry.covariance;
  }
  Eigen::Matrix3d found = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& d : tangents) found += (d - mean) * (d - mean).transpose() / (kRuns - 1);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      // A sample covariance scatters by sqrt((P_ii P_jj + P_ij^2) / n).
      const double sigma = std::sqrt((claimed(i, i) * claimed(j, j) + claimed(i, j) * claimed(i, j)) / kRuns);
      EXPECT_NEAR(found(i, j), claimed(i, j), 4.5 * sigma) << i << j;
    }
  }
}

TEST(Encoders, SameSeedSameReadingsOtherSeedOthers) {
  EncoderModel model = increments(4000);
  model.distance_noise = 0.01;
  const std::shared_ptr<const Motion> motion = makeMotion(papers::curve());
  const auto a = reckoned(deliveries(model, samples::differential(), motion, 1));
  EXPECT_EQ(a, reckoned(deliveries(model, samples::differential(), motion, 1)));
  EXPECT_NE(a, reckoned(deliveries(model, samples::differential(), motion, 2)));
}

TEST(Encoders, RefusalsNameTheKey) {
  const auto refused = [](const EncoderModel& model) { return refusedKey([&] { return validated(model); }); };
  EXPECT_EQ(refused({}), "accepted");
  EXPECT_EQ(refused({.ticks_per_turn = 0}), "ticks_per_turn");
  EXPECT_EQ(refused({.counter_bits = 63}), "counter_bits");
  EXPECT_EQ(refused({.track_error = -0.6}), "track_error");
  EXPECT_EQ(refused({.slips = {{.window = {3, 2}}}}), "slips[0].window");
  EXPECT_EQ(refused({.slips = {{.window = {3, 5}}, {.window = {4, 6}, .side = SlipEvent::Side::Left}}}),
            "slips[1].window");
  EXPECT_EQ(refused({.slips = {{.window = {3, 5}, .ratio = -2}}}), "slips[0].ratio");
  const std::shared_ptr<const Motion> motion = makeMotion(papers::curve());
  EXPECT_EQ(refusedKey([&] { return makeEncoderStream({}, samples::guided(), motion, {}); }), "sensor");
}

}  // namespace pos::sim
