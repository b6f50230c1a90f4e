/// Reading a rawlog of 1e6 IMU samples and 1e5 ranges: our reader, and that of the log's packed copy, beside
/// MRPT's bare streaming read of the same file. `memory_growth_kb` is how far reading raised the peak memory
/// of the process.
#include "generated_log.hpp"
#include "pos/io/log_cache.hpp"
#include "pos/io/rawlog_reader.hpp"

namespace {

constexpr int kSamples = 1'000'000;

std::string logPath() {
  static const pos::bench::GeneratedLog kLog(kSamples);
  return kLog.path();
}

/// The packed copy of the same log.
void read_copy(benchmark::State& state) {
  const std::string copy = logPath() + ".cache";
  pos::io::packLog(logPath(), copy);
  std::int64_t count = 0;
  for (auto _ : state) {
    pos::io::LogCacheReader reader(copy);
    while (const auto measurement = reader.next()) {
      benchmark::DoNotOptimize(measurement->stamp);
      ++count;
    }
  }
  state.SetItemsProcessed(count);
  std::filesystem::remove(copy);
}

void read_ours(benchmark::State& state) {
  const std::string path = logPath();
  const pos::bench::MemoryGrowth memory;
  std::int64_t count = 0;
  for (auto _ : state) {
    pos::io::RawlogReader reader(path);
    while (const auto measurement = reader.next()) {
      benchmark::DoNotOptimize(measurement->stamp);
      ++count;
    }
  }
  state.SetItemsProcessed(count);
  state.counters["memory_growth_kb"] = memory.kb();
}

void read_mrpt(benchmark::State& state) {
  mrpt::obs::registerAllClasses_mrpt_obs();
  const std::string path = logPath();
  std::int64_t count = 0;
  for (auto _ : state) count += pos::bench::objectsReadByMrpt(path);
  state.SetItemsProcessed(count);
}

BENCHMARK(read_ours)->Unit(benchmark::kMillisecond)->Iterations(1)->Apply(pos::bench::reportLargest);
BENCHMARK(read_copy)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(read_mrpt)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
