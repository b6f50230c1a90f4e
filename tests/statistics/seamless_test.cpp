/// Honesty of `seamless` over many runs whose errors are what the filters are told.
#include <gtest/gtest.h>

#include <cstdio>

#include "pos/core/chi_square.hpp"
#include "pos/estimation/seamless_core.hpp"
#include "support/circle_run.hpp"
#include "support/eskf_samples.hpp"

namespace pos::estimation {
namespace {

constexpr int kRuns = 200;
constexpr double kStep = 0.01;  // s
constexpr double kRange = 0.1;  // m, sigma
constexpr double kFix = 0.3;    // m, sigma per axis
constexpr int kMoments = 5;     // looked at, 2 s apart

enum class Sensors { Radio, Satellites, Both };

struct Nees {
  double all = 0.0;       // of fifteen states
  double position = 0.0;  // of three
};

Vector<15> normal15(RandomStream& random) {
  Vector<15> n;
  for (double& v : n) v = random.normal();
  return n;
}

SeamlessConfig honestConfig(const ins::EskfProcess& process) {
  SeamlessConfig config;
  config.variant = SeamlessConfig::Variant::Imm;
  config.imu.gyro_density = process.gyro_density;
  config.imu.accelerometer_density = process.accelerometer_density;
  config.imu.gyro_bias_walk = process.gyro_bias_walk;
  config.imu.accelerometer_bias_walk = process.accelerometer_bias_walk;
  config.uwb.sigma = kRange;
  config.uwb.robust.form = filters::RobustConfig::Form::None;
  config.gnss.surprise = GnssUse::Surprise::Believe;
  config.imm.likelihood = filters::LikelihoodForm::PositionDomain;
  return config;
}

/// 10 s of a turn at 2 m/s among four anchors, every sensor in use at 10 Hz.
std::vector<Nees> honestRun(std::uint64_t seed, Sensors sensors) {
  RandomStream random(seed, 11);
  const ins::EskfProcess process;
  Vector<15> sigma;
  sigma << Vector<3>::Constant(0.3), Vector<3>::Constant(0.1), 0.01, 0.01, 0.03, Vector<3>::Constant(0.02),
      Vector<3>::Constant(5e-4);
  Belief<EskfState> start;
  start.mean.v_map = {2, 0, 0};
  start.covariance = sigma.cwiseAbs2().asDiagonal();
  EskfState truth = plus(start.mean, Vector<15>(sigma.cwiseProduct(normal15(random))));
  SeamlessCore core(honestConfig(process));
  core.start(stampFromSeconds(0.0), start);
  const Eigen::Vector3d tag(0.6, 0.0, 0.4);
  const Eigen::Vector3d antenna(-0.3, 0.0, 0.6);
  const auto map = testing::circleMap();
  std::vector<Nees> told;
  for (int k = 1; k <= 200 * kMoments; ++k) {
    const Eigen::Vector3d rate(0.02 * std::sin(0.01 * k), 0.01, 0.1);
    const Eigen::Vector3d force(0.1 * std::sin(0.02 * k), 0.2, process.gravity);
    const ins::ImuIncrement clean{kStep * (rate + truth.gyro_bias),
                                  kStep * (force + truth.accelerometer_bias), kStep};
    ins::ImuIncrement read = clean;
    read.angle += process.gyro_density * std::sqrt(kStep) * testing::normals(random);
    read.velocity += process.accelerometer_density * std::sqrt(kStep) * testing::normals(random);
    truth = ins::steppedMean(truth, clean, process.gravity);
    truth.gyro_bias += process.gyro_bias_walk * std::sqrt(kStep) * testing::normals(random);
    truth.accelerometer_bias += process.accelerometer_bias_walk * std::sqrt(kStep) * testing::normals(random);
    (void)core.propagate(read, stampFromSeconds(kStep * k));
    if (k % 10 == 0 && sensors != Sensors::Satellites) {
      for (const map::Anchor& anchor : map->anchors) {
        const double range = seenRange(truth, tag, anchor.p_map, 0.0).distance + kRange * random.normal();
        (void)core.take(range, anchor.p_map, 0.0, tag);
      }
    }
    if (k % 10 == 5 && sensors != Sensors::Radio) {
      const Eigen::Vector3d place = truth.p_map + truth.R_map_body() * antenna;
      (void)core.take(place + kFix * testing::normals(random), square(kFix) * Matrix<3, 3>::Identity(),
                      antenna);
    }
    if (k % 200 != 0) continue;
    const Belief<EskfState> best = core.closed().combined();
    const Vector<15> e = minus(truth, best.mean);
    told.push_back({e.dot(best.covariance.llt().solve(e)),
                    e.head<3>().dot(best.covariance.topLeftCorner<3, 3>().llt().solve(e.head<3>()))});
  }
  return told;
}

std::vector<Nees> meanNees(Sensors sensors) {
  std::vector<Nees> mean(kMoments);
  for (int run = 0; run < kRuns; ++run) {
    const std::vector<Nees> told = honestRun(static_cast<std::uint64_t>(run + 1), sensors);
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i].all += told[i].all / kRuns;
      mean[i].position += told[i].position / kRuns;
    }
  }
  for (const Nees& nees : mean) std::printf("NEES %.2f of 15, %.2f of 3\n", nees.all, nees.position);
  return mean;
}

/// Five moments, two figures each: one in a thousand each.
void expectHonest(Sensors sensors) {
  const Interval fifteen = meanChiSquareBounds(0.999, 15.0, kRuns);
  const Interval three = meanChiSquareBounds(0.999, 3.0, kRuns);
  for (const Nees& nees : meanNees(sensors)) {
    EXPECT_GT(nees.all, fifteen.low);
    EXPECT_LT(nees.all, fifteen.high);
    EXPECT_GT(nees.position, three.low);
    EXPECT_LT(nees.position, three.high);
  }
}

TEST(SeamlessStatistics, WithRadioAloneItIsHonest) {
  expectHonest(Sensors::Radio);
}

TEST(SeamlessStatistics, WithSatellitesAloneItIsHonest) {
  expectHonest(Sensors::Satellites);
}

TEST(SeamlessStatistics, WithBothItIsHonest) {
  expectHonest(Sensors::Both);
}

}  // namespace
}  // namespace pos::estimation
