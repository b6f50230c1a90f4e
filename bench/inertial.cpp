/// One sample of the simulated inertial unit: on the shearer's bent conveyor over the turning Earth, and on a
/// winding drive, where the position has no closed form. The yardstick is what no simulator can do without,
/// the six random numbers of a sample. `memory_growth_kb`: a stream holds no past.
#include "pos/core/angle.hpp"
#include "pos/sim/imu.hpp"
#include "pos/sim/motion_plan.hpp"
#include "support.hpp"

namespace {

using namespace pos::sim;

constexpr double kSeconds = 1000.0;
constexpr double kRate = 100.0;

MotionConfig conveyor() {
  return ShearerConfig{.bend_peak = 0.1, .floor_peak = 0.1};
}

MotionConfig winding() {
  const Change wave{.by = 20.0, .wave_amplitude = 0.5, .wave_period = 8.0};
  return SegmentMotionConfig{.start = {.speed = 1.0},
                             .segments = {{.drive = {.duration = kSeconds}, .turn = wave}}};
}

void sample_ours(benchmark::State& state, const MotionConfig& config) {
  const std::shared_ptr<const Motion> motion = makeMotion(config);
  const auto earth = std::make_shared<Earth>(
      EarthConfig{.kind = EarthKind::Level, .origin = {.latitude = pos::radians(35.0)}});
  const ImuModel model{.timing = {.rate = kRate}, .errors = navigationGrade()};
  const pos::bench::MemoryGrowth memory;
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    const auto stream = makeImuStream(model, earth, motion, {.seed = 1});
    for (int i = 0; i < static_cast<int>(kSeconds * kRate); ++i) {
      benchmark::DoNotOptimize(stream->next()->arrival);
    }
  }
  timer.report(state, "ns_per_sample", kSeconds * kRate);
  state.counters["memory_growth_kb"] = memory.kb();
}

void sample_random(benchmark::State& state) {
  pos::RandomStream random(1, 1);
  const pos::bench::PerItem timer;
  for (auto _ : state) {
    for (int i = 0; i < 6 * static_cast<int>(kSeconds * kRate); ++i)
      benchmark::DoNotOptimize(random.normal());
  }
  timer.report(state, "ns_per_sample", kSeconds * kRate);
}

BENCHMARK_CAPTURE(sample_ours, conveyor, conveyor())
    ->Unit(benchmark::kMillisecond)
    ->Apply(pos::bench::reportLargest);
BENCHMARK_CAPTURE(sample_ours, winding, winding())
    ->Unit(benchmark::kMillisecond)
    ->Apply(pos::bench::reportLargest);
BENCHMARK(sample_random)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
