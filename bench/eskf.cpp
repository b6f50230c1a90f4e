/// The error-state filter of fifteen states: one step of state and covariance, block by block and with full
/// matrices; one range by its sparse row and by the general kernel; a circle run of 73 s whole.
#include "pos/ins/eskf.hpp"

#include <memory>

#include "pos/estimation/uwb_imu.hpp"
#include "support.hpp"

namespace {

using namespace pos;
using namespace pos::estimation;

constexpr double kDt = 0.01;
constexpr int kVaried = 64;  // samples or anchors, so that no branch is learnt by heart

Belief<EskfState> belief() {
  Vector<15> sigma;
  sigma << Vector<3>::Constant(0.3), Vector<3>::Constant(0.1), 0.01, 0.01, 0.03, Vector<3>::Constant(0.02),
      Vector<3>::Constant(5e-4);
  return {EskfState{}, sigma.cwiseAbs2().asDiagonal()};
}

std::vector<ins::ImuIncrement> samples() {
  std::vector<ins::ImuIncrement> list;
  for (int i = 0; i < kVaried; ++i) {
    const Eigen::Vector3d rate(0.02 * std::sin(i), 0.03 * std::cos(1.7 * i), 0.1 + 0.05 * std::sin(2.3 * i));
    const Eigen::Vector3d force(0.3 * std::sin(0.7 * i), 0.2, 9.8 + 0.1 * std::cos(i));
    list.push_back({kDt * rate, kDt * force, kDt});
  }
  return list;
}

void predict_structured(benchmark::State& state) {
  const ins::EskfProcess process;
  const auto list = samples();
  const Belief<EskfState> start = belief();
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    Belief<EskfState> b = start;
    for (const ins::ImuIncrement& sample : list) ins::propagate(b, sample, process);
    benchmark::DoNotOptimize(b);
  }
  timer.report(state, "ns_per_sample", kVaried);
}

void predict_dense(benchmark::State& state) {
  const ins::EskfProcess process;
  const auto list = samples();
  const Belief<EskfState> start = belief();
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    Belief<EskfState> b = start;
    for (const ins::ImuIncrement& sample : list) {
      const ins::EskfStep step = ins::stepped(b.mean, sample, process.gravity);
      const Matrix<15, 15> F = step.F.dense();
      const Matrix<15, 15> carried = F * b.covariance * F.transpose();
      b.covariance = carried;
      b.covariance.diagonal() += ins::processNoise(process, sample.dt);
      b.mean = step.next;
    }
    benchmark::DoNotOptimize(b);
  }
  timer.report(state, "ns_per_sample", kVaried);
}

std::vector<PoseRow> rows(const EskfState& x) {
  std::vector<PoseRow> list;
  for (int i = 0; i < kVaried; ++i) {
    const Eigen::Vector3d anchor(20.0 * std::cos(i), 20.0 * std::sin(i), 3.0);
    list.push_back(seenRange(x, {0.6, 0.0, 0.5}, anchor, 20.0 + 0.1 * std::sin(1.3 * i)).row);
  }
  return list;
}

void range_sparse(benchmark::State& state) {
  const Belief<EskfState> start = belief();
  const auto list = rows(start.mean);
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    SequentialCorrection sequential(start);
    for (const PoseRow& row : list) benchmark::DoNotOptimize(sequential.take(row, 0.09));
    benchmark::DoNotOptimize(sequential.injected());
  }
  timer.report(state, "ns_per_range", kVaried);
}

void range_general(benchmark::State& state) {
  const Belief<EskfState> start = belief();
  const auto list = rows(start.mean);
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    Belief<EskfState> b = start;
    for (const PoseRow& row : list) {
      const filters::Innovation<EskfState, 1> innovation{Vector<1>(row.nu), row.dense()};
      benchmark::DoNotOptimize(filters::correct(b, innovation, Matrix<1, 1>(0.09)));
    }
    benchmark::DoNotOptimize(b);
  }
  timer.report(state, "ns_per_range", kVaried);
}

/// 73 s at 100 Hz with four ranges at 10 Hz.
void circle(benchmark::State& state, UwbImuConfig::Variant variant) {
  constexpr int kSamples = 7283;
  const auto map = pos::bench::ringOfAnchors(4);
  std::vector<Measurement> log;
  for (int k = 1; k <= kSamples; ++k) {
    const double t = kDt * k;
    const Stamp stamp = stampFromSeconds(1000.0 + t);
    ImuSample imu;
    imu.angular.z() = 0.2;
    imu.linear = {0.0, 0.4, 9.80665};
    log.push_back({stamp, "imu", imu});
    if (k % 10 != 0) continue;
    for (int i = 0; i < 4; ++i) {
      BeaconRange range;
      range.anchor = i;
      range.tag_body = Eigen::Vector3d::Zero();
      range.range = pos::bench::CircleDrive::range(pos::bench::CircleDrive::pose(t),
                                                   map->anchors[static_cast<std::size_t>(i)], k + i);
      log.push_back({stamp, "uwb", range});
    }
  }
  UwbImuConfig config;
  config.variant = variant;
  config.start.pose = pos::bench::CircleDrive::pose(0.0);
  config.first = {InertialStart::Levelling::InMotion, pos::bench::CircleDrive::kSpeed, 0.1, 0.01745, 0.1};
  config.aids.height_sigma = 0.1;
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    const auto estimator = makeUwbImu(config, map);
    for (const Measurement& m : log) benchmark::DoNotOptimize(estimator->ingest(m));
    benchmark::DoNotOptimize(estimator->estimateAt(log.back().stamp));
  }
  timer.report(state, "ns_per_run_second", kDt * kSamples);
}

}  // namespace

BENCHMARK(predict_structured);
BENCHMARK(predict_dense);
BENCHMARK(range_sparse);
BENCHMARK(range_general);
BENCHMARK_CAPTURE(circle, eskf, UwbImuConfig::Variant::Eskf)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(circle, ekf, UwbImuConfig::Variant::Ekf)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(circle, ukf, UwbImuConfig::Variant::Ukf)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
