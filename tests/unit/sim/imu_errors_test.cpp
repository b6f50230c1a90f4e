#include <algorithm>
#include <cmath>

#include "pos/sim/imu.hpp"
#include "unit/sim/paper_motions.hpp"
#include "unit/sim/refusals.hpp"

#include <gtest/gtest.h>

namespace pos::sim {
namespace {

constexpr double kG = 9.80665;

std::shared_ptr<const Motion> rest(double duration) {
  return makeMotion(SegmentMotionConfig{.segments = {papers::wait(duration)}});
}

std::vector<Delivery> deliveries(ImuModel model, const std::shared_ptr<const Motion>& motion,
                                 std::uint64_t seed) {
  model.timing.stream = streamOf(model.sensor);
  const auto stream = makeImuStream(model, std::make_shared<Earth>(EarthConfig{}), motion, {.seed = seed});
  std::vector<Delivery> all;
  while (auto delivery = stream->next()) all.push_back(*std::move(delivery));
  return all;
}

const ImuSample& sampleOf(const Delivery& delivery) {
  return std::get<ImuSample>(delivery.measurement.reading);
}

/// Gyro x, whose truth is 0 at rest.
std::vector<double> gyroX(const ImuModel& model, double duration, std::uint64_t seed) {
  std::vector<double> values;
  for (const Delivery& delivery : deliveries(model, rest(duration), seed))
    values.push_back(sampleOf(delivery).angular.x());
  return values;
}

struct Moments {
  double mean = 0.0;
  double sigma = 0.0;
};

Moments moments(const std::vector<double>& values) {
  Moments m;
  for (const double v : values) m.mean += v / static_cast<double>(values.size());
  for (const double v : values)
    m.sigma += (v - m.mean) * (v - m.mean) / static_cast<double>(values.size() - 1);
  m.sigma = std::sqrt(m.sigma);
  return m;
}

/// Allan deviation without overlap over clusters of `size` samples, and the number of differences.
struct Allan {
  double deviation = 0.0;
  double count = 0.0;
};

Allan allan(const std::vector<double>& values, std::size_t size) {
  std::vector<double> means;
  for (std::size_t i = 0; i + size <= values.size(); i += size) {
    double sum = 0.0;
    for (std::size_t j = i; j < i + size; ++j) sum += values[j];
    means.push_back(sum / static_cast<double>(size));
  }
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < means.size(); ++i)
    sum += (means[i + 1] - means[i]) * (means[i + 1] - means[i]);
  const auto n = static_cast<double>(means.size() - 1);
  return {std::sqrt(0.5 * sum / n), n};
}

double correlation(const std::vector<double>& values, std::size_t lag) {
  const Moments m = moments(values);
  double sum = 0.0;
  for (std::size_t i = 0; i + lag < values.size(); ++i)
    sum += (values[i] - m.mean) * (values[i + lag] - m.mean);
  return sum / static_cast<double>(values.size() - lag) / (m.sigma * m.sigma);
}

ImuModel withGyro(const TriadErrors& gyro, double rate) {
  return {.timing = {.rate = rate}, .errors = {.gyro = gyro}};
}

}  // namespace

TEST(ImuErrors, WhiteNoiseHasItsDensityByAllanDeviationAtAnyRate) {
  constexpr double kDensity = 2e-4;
  for (const double rate : {50.0, 200.0}) {
    const auto values = gyroX(withGyro({.noise_density = kDensity}, rate), 1000.0, 7);
    for (const double tau : {0.1, 1.0, 5.0}) {
      const Allan a = allan(values, static_cast<std::size_t>(std::lround(tau * rate)));
      // Differences that share a mean: relative variance of the Allan variance 3 / n; four sigmas.
      const double bound = 4.0 * std::sqrt(3.0 / a.count);
      const double ratio = a.deviation * a.deviation * tau / (kDensity * kDensity);
      EXPECT_GT(ratio, 1.0 - bound) << rate << ' ' << tau;
      EXPECT_LT(ratio, 1.0 + bound) << rate << ' ' << tau;
    }
    EXPECT_NEAR(correlation(values, 1), 0.0, 4.0 / std::sqrt(static_cast<double>(values.size())));
  }
}

TEST(ImuErrors, IncrementsCarryTheSameNoiseAsRatesTimesTheInterval) {
  ImuModel model = withGyro({.bias_sigma = 1e-3, .noise_density = 1e-3}, 100.0);
  const auto rates = gyroX(model, 5.0, 3);
  model.kind = ImuSample::Kind::Increments;
  const auto increments = gyroX(model, 5.0, 3);
  ASSERT_EQ(rates.size(), increments.size());
  for (std::size_t i = 0; i < rates.size(); ++i) EXPECT_NEAR(increments[i], rates[i] / 100.0, 1e-17);
}

TEST(ImuErrors, MovingBiasIsNotThereWhileTheVehicleStands) {
  constexpr double kBias = 1e-3;
  const std::shared_ptr<const Motion> motion = makeMotion(
      SegmentMotionConfig{.segments = {papers::wait(2.0), papers::speedUp(1.0, 0.5), papers::wait(3.0),
                                       papers::speedUp(1.0, 0.0), papers::wait(2.0)}});
  const ImuModel model = withGyro({.moving_bias = {kBias, 0.0, 0.0}}, 100.0);
  const double drift = 0.5 / 6.37e6;  // rad/s, of the level over the round Earth at this speed
  for (const Delivery& delivery : deliveries(model, motion, 1)) {
    const double t = seconds(delivery.measurement.stamp - Stamp{});
    if (std::abs(t - 2.0) < 0.02 || std::abs(t - 7.0) < 0.02) continue;
    const bool moves = t > 2.0 && t < 7.0;
    EXPECT_NEAR(sampleOf(delivery).angular.x(), moves ? kBias : 0.0, drift) << t;
  }
}

TEST(ImuErrors, BiasInstabilityHasItsSigmaAndItsCorrelationTime) {
  constexpr double kSigma = 3e-4;
  constexpr double kTau = 10.0;
  constexpr double kDuration = 200000.0;
  const auto values =
      gyroX(withGyro({.instability_sigma = kSigma, .instability_time = kTau}, 1.0), kDuration, 11);
  // Relative standard deviation of a sample variance of a Gauss-Markov process: sqrt(2 tau / T) = 1 %.
  const double bound = 4.0 * std::sqrt(2.0 * kTau / kDuration);
  const double variance = std::pow(moments(values).sigma / kSigma, 2);
  EXPECT_GT(variance, 1.0 - bound);
  EXPECT_LT(variance, 1.0 + bound);
  for (const std::size_t lag : {5UL, 10UL, 20UL}) {
    EXPECT_NEAR(correlation(values, lag), std::exp(-static_cast<double>(lag) / kTau), bound) << lag;
  }
}

TEST(ImuErrors, BiasWalkGrowsWithTheRootOfTime) {
  constexpr double kDensity = 1e-5;
  constexpr int kRuns = 400;
  std::vector<double> after_25;
  std::vector<double> after_100;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const auto values = gyroX(withGyro({.walk_density = kDensity}, 1.0), 100.0, seed);
    after_25.push_back(values[24]);
    after_100.push_back(values[99]);
  }
  // Relative standard deviation of a sample sigma: 1 / sqrt(2 n); four of them.
  const double bound = 4.0 / std::sqrt(2.0 * kRuns);
  EXPECT_NEAR(moments(after_25).sigma / (kDensity * 5.0), 1.0, bound);
  EXPECT_NEAR(moments(after_100).sigma / (kDensity * 10.0), 1.0, bound);
  EXPECT_NEAR(moments(after_100).mean, 0.0, 4.0 * kDensity * 10.0 / std::sqrt(kRuns));
}

TEST(ImuErrors, RepeatabilityIsDrawnOnceARunAndTheFixedBiasComesOnTop) {
  constexpr int kRuns = 400;
  std::vector<double> biases;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const auto values = gyroX(withGyro({.bias = {0.01, 0, 0}, .bias_sigma = 2e-3}, 10.0), 1.0, seed);
    EXPECT_EQ(values.front(), values.back());
    biases.push_back(values.front());
  }
  EXPECT_NEAR(moments(biases).mean, 0.01, 4.0 * 2e-3 / std::sqrt(kRuns));
  EXPECT_NEAR(moments(biases).sigma / 2e-3, 1.0, 4.0 / std::sqrt(2.0 * kRuns));
}

TEST(ImuErrors, ScaleAndMisalignmentActOnTheTruth) {
  ImuModel model;
  model.errors.accelerometer.scale = {0, 0, 1e-3};
  EXPECT_NEAR(sampleOf(deliveries(model, rest(1), 1).front()).linear.z(), 1.001 * kG, 1e-12);
  model.errors.accelerometer = {.misalignment_sigma = 1e-3};
  std::vector<double> leaks;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Eigen::Vector3d force = sampleOf(deliveries(model, rest(0.02), seed).front()).linear;
    leaks.push_back(force.x() / kG);
    leaks.push_back(force.y() / kG);
    EXPECT_NEAR(force.z(), kG, 1e-12);
  }
  EXPECT_NEAR(moments(leaks).sigma / 1e-3, 1.0, 4.0 / std::sqrt(2.0 * 600.0));
}

TEST(ImuErrors, FullScaleLimitsAndQuantumRounds) {
  ImuModel model;
  model.errors.accelerometer = {.quantum = 0.01, .limit = 5.0};
  EXPECT_NEAR(sampleOf(deliveries(model, rest(1), 1).front()).linear.z(), 5.0, 1e-12);
  model.errors.accelerometer.limit = 0.0;
  EXPECT_NEAR(sampleOf(deliveries(model, rest(1), 1).front()).linear.z(), 9.81, 1e-12);
}

TEST(ImuErrors, ARoundedCounterLosesNothing) {
  ImuModel model{.kind = ImuSample::Kind::Increments};
  model.errors.accelerometer.quantum = 0.01;  // m/s; an increment of gravity is 0.0981
  double sum = 0.0;
  for (const Delivery& delivery : deliveries(model, rest(60), 1)) {
    const double given = sampleOf(delivery).linear.z();
    EXPECT_NEAR(given / 0.01, std::round(given / 0.01), 1e-9);
    sum += given;
  }
  EXPECT_NEAR(sum, 60.0 * kG, 0.5001 * 0.01);
}

TEST(ImuErrors, SameSeedSameBytesOtherSeedOthers) {
  const ImuModel model{.errors = automotiveMems()};
  const auto motion = rest(2);
  const auto a = deliveries(model, motion, 5);
  const auto b = deliveries(model, motion, 5);
  const auto c = deliveries(model, motion, 6);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(sampleOf(a[i]).angular, sampleOf(b[i]).angular);
    EXPECT_EQ(sampleOf(a[i]).linear, sampleOf(b[i]).linear);
    EXPECT_NE(sampleOf(a[i]).angular, sampleOf(c[i]).angular);
  }
}

TEST(ImuErrors, AStreamDoesNotKnowWhoElseRuns) {
  const auto motion = rest(2);
  const auto alone = deliveries({.errors = automotiveMems()}, motion, 5);
  const auto earth = std::make_shared<Earth>(EarthConfig{});
  const auto streamNamed = [&](const std::string& name) {
    const Timing timing{.rate = 100.0, .stream = streamOf(name)};
    return makeImuStream({.sensor = name, .timing = timing, .errors = automotiveMems()}, earth, motion,
                         {.seed = 5});
  };
  const auto first = streamNamed("imu");
  const auto second = streamNamed("imu2");
  for (const Delivery& delivery : alone) {
    EXPECT_EQ(sampleOf(delivery).linear, sampleOf(*first->next()).linear);
    EXPECT_NE(sampleOf(delivery).linear, sampleOf(*second->next()).linear);
  }
}

TEST(ImuErrors, LostSamplesAndOneMoreErrorLeaveTheOtherNumbersAsTheyWere) {
  ImuModel model = withGyro({.noise_density = 1e-3}, 100.0);
  const auto motion = rest(2);
  const auto all = deliveries(model, motion, 5);
  model.timing.drop_probability = 0.3;
  model.timing.outages = {{1.0, 1.2}};
  model.errors.accelerometer = {.bias_sigma = 0.1, .noise_density = 1e-2};
  const auto some = deliveries(model, motion, 5);
  EXPECT_GT(some.size(), 90U);
  EXPECT_LT(some.size(), 160U);
  std::size_t j = 0;
  for (const Delivery& delivery : all) {
    if (j < some.size() && some[j].measurement.stamp == delivery.measurement.stamp) {
      EXPECT_EQ(sampleOf(some[j]).angular, sampleOf(delivery).angular);
      ++j;
    }
  }
  EXPECT_EQ(j, some.size());
}

TEST(ImuErrors, SamplesThatStrayFromTheirBeatStillTellAllOfTheMotion) {
  ImuModel model{.kind = ImuSample::Kind::Increments, .timing = {.rate = 50.0, .jitter = 0.002}};
  double velocity = 0.0;
  double time = 0.0;
  double last = 0.0;
  bool uneven = false;
  for (const Delivery& delivery : deliveries(model, rest(10), 3)) {
    const ImuSample& sample = sampleOf(delivery);
    EXPECT_NEAR(sample.linear.z(), kG * seconds(*sample.interval), 1e-7);
    uneven = uneven || std::abs(seconds(*sample.interval) - 0.02) > 1e-3;
    velocity += sample.linear.z();
    time += seconds(*sample.interval);
    last = secondsSinceOrigin(delivery.measurement.stamp);
  }
  EXPECT_TRUE(uneven);
  EXPECT_NEAR(velocity, kG * time, 1e-9);
  // Intervals touch each other. The first is that of the first tick later than one interval: 0.04 s + 0.45 *
  // 0.02 s at most.
  EXPECT_GE(last - time, -1e-9);
  EXPECT_LE(last - time, 0.029 + 1e-9);
}

TEST(ImuErrors, PresetsAreThoseOfThePapers) {
  EXPECT_NEAR(navigationGrade().gyro.bias.x(), 2.424e-7, 1e-10);
  EXPECT_NEAR(navigationGrade().gyro.noise_density, 2.909e-6, 1e-9);
  EXPECT_NEAR(navigationGrade().accelerometer.noise_density, 9.80665e-5, 1e-12);
  EXPECT_NEAR(laboratoryMems().gyro.bias_sigma, 3.4907e-4, 1e-8);
}

TEST(ImuErrors, RefusalsNameTheKey) {
  const auto refused = [](const ImuModel& model) { return refusedKey([&] { return validated(model); }); };
  EXPECT_EQ(refused({}), "accepted");
  EXPECT_EQ(refused({.sensor = ""}), "sensor");
  EXPECT_EQ(refused({.timing = {.rate = 0}}), "rate");
  EXPECT_EQ(refused({.p_body = {NAN, 0, 0}}), "p_body");
  EXPECT_EQ(refused({.errors = {.gyro = {.noise_density = -1}}}), "errors.gyro.noise_density");
  EXPECT_EQ(refused({.errors = {.accelerometer = {.instability_time = 0}}}),
            "errors.accelerometer.instability_time");
}

}  // namespace pos::sim
