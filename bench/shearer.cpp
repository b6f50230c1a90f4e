/// The shearer's filter: a sample of strapdown, a scan (four samples, the covariance's step and one leg), and
/// the same scan with the covariance in full matrices of Eigen for a yardstick.
#include "pos/estimation/shearer_filter.hpp"

#include "pos/estimation/shearer.hpp"
#include "support.hpp"

namespace {

using namespace pos;
using namespace pos::estimation;

const ins::ImuIncrement kSample{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.09797}, 0.01};

ShearerFilter started() {
  ShearerConfig config;
  ShearerFilter filter(config, 2);
  filter.start(ins::Earth::level({0.0, 5.97e-5, 4.18e-5}, 9.797), shearerStart(config, {}),
               shearerStartCovariance(config, {}));
  (void)filter.step(kSample);
  (void)filter.see({-9.7, 4.0, 0.0}, config.legs.sigma.cwiseAbs2().asDiagonal(), 0.0);
  return filter;
}

void shearer_sample(benchmark::State& state) {
  ShearerFilter filter = started();
  const pos::bench::PerItem timer;
  for (auto _ : state) benchmark::DoNotOptimize(filter.step(kSample));
  timer.report(state, "ns_per_sample", 1);
}

void shearer_scan_ours(benchmark::State& state) {
  ShearerFilter filter = started();
  const Eigen::Matrix3d R = ShearerConfig{}.legs.sigma.cwiseAbs2().asDiagonal();
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    for (int i = 0; i < 4; ++i) (void)filter.step(kSample);
    benchmark::DoNotOptimize(filter.see({-9.7, 4.0, 0.0}, R, 0.0));
  }
  timer.report(state, "ns_per_scan", 1);
}

void shearer_scan_dense(benchmark::State& state) {
  using Square = Eigen::Matrix<double, 18, 18>;
  Square P = 1e-4 * Square::Identity();
  Square Phi = Square::Identity();
  Phi.block<3, 3>(6, 3) = 0.04 * Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, 18> H = Eigen::Matrix<double, 3, 18>::Zero();
  H.block<3, 3>(0, 6) = -Eigen::Matrix3d::Identity();
  H.block<3, 3>(0, 15).setIdentity();
  const Eigen::Matrix3d R = 1e-4 * Eigen::Matrix3d::Identity();
  const Square Q = 1e-12 * Square::Identity();
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    P = (Phi * P * Phi.transpose() + Q).eval();
    const Eigen::Matrix3d S = H * P * H.transpose() + R;
    const Eigen::Matrix<double, 18, 3> K = P * H.transpose() * S.inverse();
    const Square rest = Square::Identity() - K * H;
    P = (rest * P * rest.transpose() + K * R * K.transpose()).eval();
    benchmark::DoNotOptimize(P);
  }
  timer.report(state, "ns_per_scan", 1);
}

}  // namespace

BENCHMARK(shearer_sample);
BENCHMARK(shearer_scan_ours);
BENCHMARK(shearer_scan_dense);
BENCHMARK_MAIN();
