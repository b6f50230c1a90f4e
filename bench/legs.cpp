/// Legs of supports in a sweep of 721 beams, 17 of them in view: the whole row, and the part of it that a
/// filter needs. The yardstick is the simulator's own work on the same sweep, beside which the detection must
/// not matter: hours of sweeps are made and searched in one go.
#include <variant>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/lidar/icp.hpp"
#include "pos/lidar/legs.hpp"
#include "pos/sim/leg_stream.hpp"
#include "pos/sim/shearer.hpp"
#include "support.hpp"

namespace {

constexpr int kSweeps = 1000;

pos::sim::LegConfig scanner() {
  pos::sim::LegConfig config;
  config.model = pos::sim::LegModel::Legs;
  config.scanner.range_max = 15.0;
  config.scanner.sigma_angle = pos::radians(0.02);
  return config;
}

pos::sim::LegStream stream() {
  const pos::sim::LegConfig config = scanner();
  const std::shared_ptr<const pos::sim::Motion> motion = pos::sim::makeShearerMotion({});
  return {config, pos::sim::straightRow(config.row, 4.0, 1.0, {}), motion, {.seed = 1}};
}

std::vector<pos::Scan2D> sweeps() {
  pos::sim::LegStream made = stream();
  std::vector<pos::Scan2D> all;
  for (int i = 0; i < kSweeps; ++i) all.push_back(std::get<pos::Scan2D>(made.next()->measurement.reading));
  return all;
}

void find(benchmark::State& state, const pos::lidar::AlongFace& part, pos::lidar::ArcWeights weights) {
  const std::vector<pos::Scan2D> scans = sweeps();
  pos::lidar::LegFinder finder({.weights = weights});
  (void)finder.find(scans.front());
  const pos::bench::MemoryGrowth memory;
  const pos::bench::PerItem timer;
  std::size_t legs = 0;
  for (auto _ : state) {
    for (const pos::Scan2D& scan : scans) legs += finder.find(scan, part).legs.size();
  }
  timer.report(state, "ns_per_sweep", kSweeps);
  state.counters["legs_per_sweep"] =
      static_cast<double>(legs) / (kSweeps * static_cast<double>(state.iterations()));
  state.counters["memory_growth_kb"] = memory.kb();
}

void sweep_simulated(benchmark::State& state) {
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    pos::sim::LegStream made = stream();
    for (int i = 0; i < kSweeps; ++i) benchmark::DoNotOptimize(made.next()->arrival);
  }
  timer.report(state, "ns_per_sweep", kSweeps);
}

BENCHMARK_CAPTURE(find, whole_row, {}, pos::lidar::ArcWeights::Noise)
    ->Unit(benchmark::kMillisecond)
    ->Apply(pos::bench::reportLargest);
BENCHMARK_CAPTURE(find, whole_row_robust, {}, pos::lidar::ArcWeights::Huber)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(find, two_legs_behind, {.from = -11.5, .to = -8.5}, pos::lidar::ArcWeights::Noise)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(sweep_simulated)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
