/// The particle filter with a million particles: one thread beside two, by the clock on the wall, and its
/// memory. A step is a motion, four ranges with the sums that a gate needs, and resampling.
#include <tbb/task_arena.h>
#include <algorithm>

#include "mcl_scene.hpp"

namespace pos::bench {
namespace {

void step(Cloud& cloud, estimation::RangeWeights& weights, filters::SystematicResampler& resampler,
          std::uint64_t number) {
  const std::size_t count = cloud.set.size();
  propagate(cloud.set, cloud.headings, kMotion, 1, number);
  for (const Eigen::Vector3d& anchor : kAnchors) {
    const Eigen::Vector3d p(anchor.x() - cloud.set.origin.x(), anchor.y() - cloud.set.origin.y(), anchor.z());
    const estimation::RangeTerm term{.anchor = p, .tag = kTag, .range = rangeTo(anchor)};
    benchmark::DoNotOptimize(weights.evaluate(cloud.set, cloud.headings, term));
    weights.apply(cloud.set);
  }
  resampler.resample(cloud.set, count, 0.3);
}

void million(benchmark::State& state) {
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  arena.execute([&] {
    const MemoryGrowth growth;
    Cloud cloud(kMillion);
    estimation::RangeWeights weights;
    filters::SystematicResampler resampler;
    std::uint64_t number = 0;
    step(cloud, weights, resampler, number++);  // the buffers are there before the clock starts
    for (auto _ : state) step(cloud, weights, resampler, number++);
    // Only the first of several repetitions finds no memory of an earlier one.
    static double bytes = 0.0;
    bytes = std::max(bytes, 1024.0 * growth.kb() / static_cast<double>(kMillion));
    state.counters["bytes_per_particle"] = bytes;
  });
}
BENCHMARK(million)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pos::bench

BENCHMARK_MAIN();
