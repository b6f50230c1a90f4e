/// Whole replays of 1e6 IMU samples and 1e5 ranges (reader, sequencer, and `range_odometry` with an estimate
/// at every epoch or the error-state filter of `uwb_imu` with one every 50 ms) beside MRPT's bare streaming
/// read of the same file. `memory_growth_kb` of the replay and of one three times as long says whether the
/// memory depends on the length.
#include "generated_log.hpp"
#include "pos/estimation/factory.hpp"
#include "pos/estimation/range_odometry.hpp"
#include "pos/estimation/sequencer.hpp"
#include "pos/io/log_cache.hpp"
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

/// The inertial filter on the drive's own inertial unit and radio.
pos::estimation::UwbImuConfig inertialConfig() {
  pos::estimation::UwbImuConfig config;
  config.start.mode = pos::estimation::StartMode::Known;
  config.start.pose = pos::bench::CircleDrive::pose(0.0);
  config.first.levelling = pos::estimation::InertialStart::Levelling::InMotion;
  config.first.speed = pos::bench::CircleDrive::kSpeed;
  config.tags = {{.id = 0, .p_body = Eigen::Vector3d::Zero()}};
  return config;
}

struct Tally {
  std::int64_t measurements = 0;
  std::int64_t applied = 0;
  std::int64_t estimates = 0;
};

class Replay {
 public:
  /// An estimate after the last measurement of an epoch, `step` apart at least.
  Replay(pos::estimation::Estimator& filter, pos::Duration step) : filter_(filter), step_(step) {}

  Tally run(pos::io::LogReader& reader) {
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
    if (!epoch_ || (last_ && *epoch_ - *last_ < step_)) return;
    const auto estimate = filter_.estimateAt(*epoch_);
    tally_.estimates += estimate ? 1 : 0;
    last_ = epoch_;
    benchmark::DoNotOptimize(estimate);
  }

  pos::estimation::Estimator& filter_;
  pos::Duration step_;
  pos::estimation::Sequencer sequencer_{pos::Duration{0}};
  std::optional<pos::Stamp> epoch_;
  std::optional<pos::Stamp> last_;
  Tally tally_;
};

void report(benchmark::State& state, const Tally& tally, const pos::bench::MemoryGrowth& memory) {
  state.SetItemsProcessed(state.iterations() * tally.measurements);
  state.counters["applied"] = static_cast<double>(tally.applied);
  state.counters["estimates"] = static_cast<double>(tally.estimates);
  state.counters["memory_growth_kb"] = memory.kb();
}

void replay_ours(benchmark::State& state) {
  const std::string path = log(static_cast<int>(state.range(0))).path();
  const pos::bench::MemoryGrowth memory;
  Tally tally;
  for (auto _ : state) {
    pos::estimation::RangeOdometry filter(config(), pos::bench::ringOfAnchors(pos::bench::kLogAnchors));
    pos::io::RawlogReader reader(path);
    tally = Replay(filter, pos::Duration{0}).run(reader);
  }
  report(state, tally, memory);
}

constexpr pos::Duration kRecorded = std::chrono::milliseconds(50);  // as `pos replay` does by default

void runInertial(benchmark::State& state, const std::string& path) {
  const pos::bench::MemoryGrowth memory;
  Tally tally;
  for (auto _ : state) {
    const auto filter =
        pos::estimation::makeEstimator(inertialConfig(), pos::bench::ringOfAnchors(pos::bench::kLogAnchors));
    const auto reader = pos::io::openLogItself(path);
    tally = Replay(*filter, kRecorded).run(*reader);
  }
  report(state, tally, memory);
}

void replay_eskf(benchmark::State& state) {
  runInertial(state, log(static_cast<int>(state.range(0))).path());
}

/// The same from the log's packed copy.
void replay_eskf_copy(benchmark::State& state) {
  const std::string copy = log(1).path() + ".cache";
  pos::io::packLog(log(1).path(), copy);
  runInertial(state, copy);
  std::filesystem::remove(copy);
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
BENCHMARK(replay_eskf)
    ->Arg(1)
    ->Arg(3)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1)
    ->Apply(pos::bench::reportLargest);
BENCHMARK(replay_eskf_copy)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(replay_mrpt_read)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
