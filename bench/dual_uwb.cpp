/// `dual_uwb` for a full epoch of two tags and four anchors (8 ranges): the filter on raw ranges, and one
/// rigid multilateration. Beside them the same rigid fit started from its prediction, and one tag alone.
#include <vector>

#include "pos/estimation/dual_uwb_filter.hpp"
#include "support.hpp"

namespace {

using pos::estimation::DualUwbConfig;

constexpr int kEpochs = 200;  // per iteration, after a fresh start
const Eigen::Vector3d kLeft(0.0, 0.375, 1.0);
const Eigen::Vector3d kRight(0.0, -0.375, 1.0);

std::shared_ptr<const pos::map::TunnelMap> site() {
  auto map = std::make_shared<pos::map::TunnelMap>();
  map->name = "double lane";
  map->anchors = {{1, "", {0, 4, 2}}, {2, "", {29, 4, 2}}, {3, "", {29, -4, 2}}, {4, "", {0, -4, 2}}};
  return map;
}

pos::Pose2 poseAt(double t) {
  return {5.0 + t, 0.5 * std::sin(0.3 * t), 0.15 * std::cos(0.3 * t)};
}

/// Ranges of one moment, off by a repeatable few centimetres.
std::vector<pos::uwb::BodyRange> epochAt(double t) {
  std::vector<pos::uwb::BodyRange> ranges;
  for (int tag = 0; tag < 2; ++tag) {
    for (const pos::map::Anchor& anchor : site()->anchors) {
      const Eigen::Vector3d& mount = tag == 0 ? kLeft : kRight;
      const double exact = pos::uwb::predictedRange(poseAt(t), 0.0, mount, anchor.p_map).distance;
      const double error = 0.04 * std::sin(1.7 * t * 31.0 + 2.1 * anchor.id + 5.0 * tag);
      ranges.push_back({tag, mount, anchor.p_map, exact + error, 0.05});
    }
  }
  return ranges;
}

pos::Stamp stampAt(int epoch) {
  return pos::stampFromSeconds(1.7e9) + epoch * pos::durationFromSeconds(0.1);
}

/// What an application pays: eight measurements ingested, prediction and gates included.
void filter_epoch(benchmark::State& state, double link_bias_sigma) {
  DualUwbConfig config;
  config.tags = {{0, kLeft}, {1, kRight}};
  config.link_bias.sigma = link_bias_sigma;
  pos::estimation::DualUwbFilter filter(config, site());
  std::vector<pos::Measurement> readings;
  for (int k = 1; k <= kEpochs; ++k) {
    int i = 0;
    for (const pos::uwb::BodyRange& range : epochAt(0.1 * k)) {
      pos::BeaconRange reading;
      reading.tag = range.tag;
      reading.anchor = 1 + i++ % 4;
      reading.range = range.range;
      readings.push_back({stampAt(k), "uwb", reading});
    }
  }
  std::int64_t applied = 0;
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    filter.reset(stampAt(0), {poseAt(0.0), pos::Vector<3>(1e-3, 1e-3, 1e-3).asDiagonal()});
    for (const pos::Measurement& reading : readings) {
      applied += filter.ingest(reading).verdict == pos::Verdict::Applied ? 1 : 0;
    }
  }
  per_item.report(state, "ns_per_epoch", kEpochs);
  state.counters["applied_share"] =
      static_cast<double>(applied) / (8.0 * kEpochs * static_cast<double>(state.iterations()));
}

enum class Start { Nothing, Prediction };

void rigid_epoch(benchmark::State& state, Start start) {
  const pos::uwb::ResidualTest test;
  std::vector<std::vector<pos::uwb::BodyRange>> epochs;
  for (int k = 0; k < kEpochs; ++k) epochs.push_back(epochAt(0.1 * k));
  std::int64_t solved = 0;
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    for (int k = 0; k < kEpochs; ++k) {
      const auto& ranges = epochs[static_cast<std::size_t>(k)];
      solved += (start == Start::Nothing ? pos::uwb::rigidFixes(ranges, 0.0, test)
                                         : pos::uwb::rigidFixNear(ranges, 0.0, poseAt(0.1 * k + 0.1), test))
                    .count;
    }
  }
  per_item.report(state, "ns_per_epoch", kEpochs);
  state.counters["fixes"] = static_cast<double>(solved) / (kEpochs * static_cast<double>(state.iterations()));
}

void tag_epoch(benchmark::State& state) {
  const pos::uwb::ResidualTest test;
  std::vector<pos::uwb::TagRange> ranges;
  for (const pos::uwb::BodyRange& range : epochAt(3.0)) {
    if (range.tag == 0) ranges.push_back({range.anchor_map.head<2>(), 1.0, range.range, 0.05});
  }
  const pos::bench::PerItem per_item;
  for (auto _ : state) benchmark::DoNotOptimize(pos::uwb::multilaterated(ranges, test).count);
  per_item.report(state, "ns_per_epoch", 1);
}

BENCHMARK_CAPTURE(filter_epoch, ranges_8, 0.0);
BENCHMARK_CAPTURE(filter_epoch, ranges_8_with_8_bias_states, 0.05);
BENCHMARK_CAPTURE(rigid_epoch, ranges_8, Start::Nothing);
BENCHMARK_CAPTURE(rigid_epoch, ranges_8_from_prediction, Start::Prediction);
BENCHMARK(tag_epoch);

}  // namespace

BENCHMARK_MAIN();
