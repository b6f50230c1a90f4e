/// The inertial filter: one sample of strapdown with its share of the covariance's step (every 50 ms, ten
/// samples at 200 Hz), one comparison of the two positions, and `sins_dr` whole over a drive of an hour. The
/// yardstick is the same filter of 19 states in full fixed-size Eigen matrices.
#include "pos/estimation/sins_dr.hpp"

#include <memory>

#include "support.hpp"

namespace {

using namespace pos;
using namespace pos::estimation;

constexpr int kSamples = 10;  // in one step of the covariance
constexpr double kDt = 0.005;
constexpr double kSpeed = 3.0;    // m/s, on a circle
constexpr double kYawRate = 0.1;  // rad/s

Belief<SinsDrState> belief(const ins::Earth& earth) {
  SinsDrState x;
  x.earth = earth;
  x.nav.v_n = {kSpeed, 0.0, 0.0};
  x.nav.coordinates = earth.isFlat() ? Eigen::Vector3d(10, 20, -300) : Eigen::Vector3d(2.0, 0.6, -300.0);
  x.wheel_coordinates = x.nav.coordinates;
  Vector<21> sigma;
  sigma << Vector<3>::Constant(0.005), Vector<3>::Constant(0.05), Vector<3>::Constant(0.1),
      Vector<3>::Constant(1e-4), Vector<3>::Constant(0.02), Vector<3>::Constant(0.12), 0.01, 0.0, 0.0;
  return {x, sigma.cwiseAbs2().asDiagonal()};
}

ins::ImuIncrement sample() {
  return {kDt * Eigen::Vector3d(0, 0, kYawRate), kDt * Eigen::Vector3d(0, kSpeed * kYawRate, 9.80665), kDt};
}

SinsDrInput input() {
  SinsDrInput in;
  in.force_b = {0.0, kSpeed * kYawRate, 9.80665};
  in.wheel_v_n = {kSpeed, 0.0, 0.0};
  in.wheel_speed = kSpeed;
  in.wheel_interval = 0.02;
  return in;
}

/// Keeps the state of the benchmark where it was: only its arithmetic counts.
template <class Carry>
void samples(benchmark::State& state, const ins::Earth& earth, const Carry& carry) {
  const Belief<SinsDrState> start = belief(earth);
  const SinsDrInput in = input();
  const ins::ImuIncrement increment = sample();
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    Belief<SinsDrState> b = start;
    ins::ImuIncrement before = increment;
    for (int i = 0; i < kSamples; ++i) {
      benchmark::DoNotOptimize(before);
      b.mean.nav = ins::stepped(earth, b.mean.nav, ins::compensated(increment, before));
    }
    carry(b, in);
    benchmark::DoNotOptimize(b);
  }
  timer.report(state, "ns_per_sample", kSamples);
}

void sample_ours(benchmark::State& state, const ins::Earth& earth) {
  const SinsDrConfig config;
  samples(state, earth, [&](Belief<SinsDrState>& b, const SinsDrInput& in) {
    estimation::propagate(b, config, in, kSamples * kDt);
  });
}

void sample_dense(benchmark::State& state, const ins::Earth& earth) {
  const SinsDrConfig config;
  samples(state, earth, [&](Belief<SinsDrState>& b, const SinsDrInput& in) {
    const double dt = kSamples * kDt;
    const Matrix<19, 19> FT = dt * sinsDrErrorF(b.mean, in).topLeftCorner<19, 19>();
    const Matrix<19, 19> Phi = Matrix<19, 19>::Identity() + FT + 0.5 * FT * FT;
    const Matrix<19, 19> q = sinsDrNoise(config, b.mean, in).topLeftCorner<19, 19>();
    const Matrix<19, 19> P = b.covariance.topLeftCorner<19, 19>();
    const Matrix<19, 19> Qd = 0.5 * dt * (Phi * q * Phi.transpose() + q);
    b.covariance.topLeftCorner<19, 19>() = Phi * P * Phi.transpose() + Qd;
  });
}

void sample_strapdown(benchmark::State& state, const ins::Earth& earth) {
  samples(state, earth, [](Belief<SinsDrState>&, const SinsDrInput&) {});
}

void update_ours(benchmark::State& state) {
  const Belief<SinsDrState> start = belief(ins::Earth::flat());
  const Matrix<3, 3> R = 4e-4 * Matrix<3, 3>::Identity();
  Belief<SinsDrState> b = start;
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    b.covariance.diagonal() = start.covariance.diagonal();
    benchmark::DoNotOptimize(correctDifference(b, 0.0, R));
    benchmark::DoNotOptimize(b);
  }
  timer.report(state, "ns_per_update", 1);
}

void update_dense(benchmark::State& state) {
  const Belief<SinsDrState> start = belief(ins::Earth::flat());
  const Matrix<3, 3> R = 4e-4 * Matrix<3, 3>::Identity();
  SinsDrState x = start.mean;
  Matrix<19, 19> P = start.covariance.topLeftCorner<19, 19>();
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    P.diagonal() = start.covariance.diagonal().head<19>();
    const auto difference = positionDifference(x, 0.0);
    const Matrix<3, 19> H = difference.H.leftCols<19>();
    const Matrix<3, 3> S = H * P * H.transpose() + R;
    const Matrix<19, 3> K = P * H.transpose() * S.inverse();
    P = ((Matrix<19, 19>::Identity() - K * H) * P).eval();
    Vector<21> d = Vector<21>::Zero();
    d.head<19>() = K * difference.nu;
    x = plus(x, d);
    benchmark::DoNotOptimize(P);
  }
  timer.report(state, "ns_per_update", 1);
}

/// A minute of it, again and again with later stamps: what a replay from memory is.
void drive_ours(benchmark::State& state) {
  constexpr int kRate = 200;
  constexpr int kMinutes = 60;
  SinsDrConfig config;
  config.odometer.track = 1.7;
  config.alignment.time = 2.0;
  const auto map = std::make_shared<map::TunnelMap>();
  std::vector<Measurement> minute;
  for (int i = 0; i < 60 * kRate; ++i) {
    const Stamp stamp = stampFromSeconds(1000.0 + kDt * i);
    ImuSample imu;
    // A ripple that sums to nothing, so that the unit is not taken to stand.
    const double ripple = i % 2 == 0 ? 0.3 : -0.3;
    imu.angular = {0.0, 0.0, kYawRate};
    imu.linear = {ripple, kSpeed * kYawRate, 9.80665 + ripple};
    minute.push_back({stamp, "imu", imu});
    if (i % 4 == 0) {
      const double half = 0.5 * kYawRate * config.odometer.track;
      minute.push_back({stamp, "wheels", WheelSpeeds{.left = kSpeed - half, .right = kSpeed + half}});
    }
  }
  for (auto _ : state) {
    auto log = minute;
    SinsDr estimator(config, map);
    for (int lap = 0; lap < kMinutes; ++lap) {
      for (Measurement& m : log) {
        benchmark::DoNotOptimize(estimator.ingest(m));
        m.stamp += durationFromSeconds(60.0);
      }
    }
    benchmark::DoNotOptimize(estimator.estimateAt(log.back().stamp));
  }
  state.counters["epochs_per_s"] = benchmark::Counter(
      static_cast<double>(kRate) * 60.0 * kMinutes * static_cast<double>(state.iterations()),
      benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(sample_ours, flat, ins::Earth::flat());
BENCHMARK_CAPTURE(sample_ours, ellipsoid, ins::Earth::ellipsoid());
BENCHMARK_CAPTURE(sample_dense, flat, ins::Earth::flat());
BENCHMARK_CAPTURE(sample_dense, ellipsoid, ins::Earth::ellipsoid());
BENCHMARK_CAPTURE(sample_strapdown, flat, ins::Earth::flat());
BENCHMARK_CAPTURE(sample_strapdown, ellipsoid, ins::Earth::ellipsoid());
BENCHMARK(update_ours);
BENCHMARK(update_dense);
BENCHMARK(drive_ours)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
