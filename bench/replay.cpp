/// A whole replay (reader, sequencer, range_odometry, an estimate at every epoch) of 1e6 IMU samples and 1e5
/// ranges beside MRPT's bare streaming read of the same file. `memory_growth_kb` of the replay and of one
/// three times as long says whether the memory depends on the length.
#include "generated_log.hpp"
#include "pos/estimation/range_odometry.hpp"
#include "pos/estimation/sequencer.hpp"
#include "pos/io/rawlog_reader.hpp"

namespace {

using pos::bench::GeneratedLog;
constexpr int kSamples = 1'000'000;

const GeneratedLog& log(int lengths) {
  static const GeneratedLog kShort(kSamples);
  if (lengths == 1) return kShort;
  static const GeneratedLog kLong(lengths * kSamples);
  return kLong;
}

/// No odometry in the log: constant velocity, which has no use for the IMU and says so at every sample.
pos::estimation::RangeOdometryConfig config() {
  pos::estimation::RangeOdometryConfig config;
  config.motion = pos::estimation::RangeOdometryConfig::Motion::ConstantVelocity;
  config.start.mode = pos::estimation::StartMode::Known;
  config.start.pose = pos::bench::CircleDrive::pose(0.0);
  return config;
}

struct Tally {
  std::int64_t measurements = 0;
  std::int64_t applied = 0;
  std::int64_t estimates = 0;
};

class Replay {
 public:
  Tally run(const std::string& path) {
    pos::io::RawlogReader reader(path);
    while (auto measurement = reader.next()) {
      sequencer_.push(std::move(*measurement));
      drain();
    }
    sequencer_.finish();
    drain();
    return tally_;
  }

 private:
  void drain() {
    while (const auto measurement = sequencer_.pop()) {
      if (epoch_ != measurement->stamp) endEpoch();
      epoch_ = measurement->stamp;
      const pos::IngestReport report = filter_.ingest(*measurement);
      tally_.applied += report.verdict == pos::Verdict::Applied ? 1 : 0;
      ++tally_.measurements;
    }
  }
  void endEpoch() {
    if (!epoch_) return;
    const auto estimate = filter_.estimateAt(*epoch_);
    tally_.estimates += estimate ? 1 : 0;
    benchmark::DoNotOptimize(estimate);
  }

  pos::estimation::Sequencer sequencer_{pos::Duration{0}};
  pos::estimation::RangeOdometry filter_{config(), pos::bench::ringOfAnchors(pos::bench::kLogAnchors)};
  std::optional<pos::Stamp> epoch_;
  Tally tally_;
};

void replay_ours(benchmark::State& state) {
  const std::string path = log(static_cast<int>(state.range(0))).path();
  const pos::bench::MemoryGrowth memory;
  Tally tally;
  for (auto _ : state) tally = Replay().run(path);
  state.SetItemsProcessed(state.iterations() * tally.measurements);
  state.counters["applied"] = static_cast<double>(tally.applied);
  state.counters["estimates"] = static_cast<double>(tally.estimates);
  state.counters["memory_growth_kb"] = memory.kb();
}

void replay_mrpt_read(benchmark::State& state) {
  mrpt::obs::registerAllClasses_mrpt_obs();
  const std::string path = log(1).path();
  std::int64_t count = 0;
  for (auto _ : state) count += pos::bench::objectsReadByMrpt(path);
  state.SetItemsProcessed(count);
}

BENCHMARK(replay_ours)
    ->Arg(1)
    ->Arg(3)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->Apply(pos::bench::reportLargest);
BENCHMARK(replay_mrpt_read)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
