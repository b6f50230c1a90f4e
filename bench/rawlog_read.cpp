/// Reading a rawlog of 1e6 IMU samples and 1e5 ranges: our reader beside MRPT's bare streaming read of the
/// same file. `max_rss_growth_kb` is how far reading raised the peak memory of the process.
#include <benchmark/benchmark.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/registerAllClasses.h>
#include <mrpt/serialization/CArchive.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "pos/io/rawlog_reader.hpp"
#include "pos/io/rawlog_writer.hpp"

namespace {

constexpr int kSamples = 1'000'000;
constexpr int kSamplesPerRange = 10;

/// The generated log, removed at exit.
class GeneratedLog {
 public:
  GeneratedLog()
      : path_(std::filesystem::temp_directory_path() /
              ("pos_bench_" + std::to_string(::getpid()) + ".rawlog")) {
    pos::io::RawlogWriter writer(path_.string());
    for (int i = 0; i < kSamples; ++i) {
      const pos::Stamp stamp = pos::stampFromSeconds(1.7e9) + pos::Duration{5'000'000LL * i};
      pos::ImuSample sample;
      sample.angular = {1e-3 * (i % 17), -1e-3 * (i % 5), 1e-2 * (i % 11)};
      sample.linear = {1e-2 * (i % 7), 1e-2 * (i % 13), 9.81};
      writer.write({stamp, "imu", sample});
      if (i % kSamplesPerRange != 0) continue;
      pos::BeaconRange range;
      range.anchor = i % 8;
      range.range = 5.0 + 0.001 * (i % 1000);
      writer.write({stamp, "uwb", range});
    }
    writer.close();
  }
  GeneratedLog(const GeneratedLog&) = delete;
  GeneratedLog& operator=(const GeneratedLog&) = delete;
  ~GeneratedLog() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string logPath() {
  static const GeneratedLog kLog;
  return kLog.path();
}

double peakMemoryKb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss);
}

void posReader(benchmark::State& state) {
  const std::string path = logPath();
  const double before = peakMemoryKb();
  std::int64_t count = 0;
  for (auto _ : state) {
    pos::io::RawlogReader reader(path);
    while (const auto measurement = reader.next()) {
      benchmark::DoNotOptimize(measurement->stamp);
      ++count;
    }
  }
  state.SetItemsProcessed(count);
  state.counters["max_rss_growth_kb"] = peakMemoryKb() - before;
}

void mrptStreamingRead(benchmark::State& state) {
  mrpt::obs::registerAllClasses_mrpt_obs();
  const std::string path = logPath();
  std::int64_t count = 0;
  for (auto _ : state) {
    mrpt::io::CFileGZInputStream file(path);
    auto archive = mrpt::serialization::archiveFrom(file);
    try {
      for (;;) {
        mrpt::serialization::CSerializable::Ptr object;
        archive >> object;
        benchmark::DoNotOptimize(object);
        ++count;
      }
    } catch (const mrpt::serialization::CExceptionEOF&) {
      continue;
    }
  }
  state.SetItemsProcessed(count);
}

BENCHMARK(posReader)->Unit(benchmark::kMillisecond)->Repetitions(3)->Iterations(1);
BENCHMARK(mrptStreamingRead)->Unit(benchmark::kMillisecond)->Repetitions(3)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
