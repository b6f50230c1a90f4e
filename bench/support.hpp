#pragma once
/// What the benchmarks share: counters per item, the peak memory, a drive among anchors.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "pos/core/angle.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::bench {

/// Processor time from its making, as a counter of nanoseconds for each of `items` per iteration.
class PerItem {
 public:
  void report(benchmark::State& state, const char* name, double items) const {
    const double spent = static_cast<double>(std::clock() - start_) / static_cast<double>(CLOCKS_PER_SEC);
    state.counters[name] = 1e9 * spent / (items * static_cast<double>(state.iterations()));
  }

 private:
  std::clock_t start_ = std::clock();
};

/// The peak of this program's own memory. getrusage would tell that of the program which started it where
/// that was larger, as `pos bench` is.
inline double peakMemoryKb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kb = 0.0;
    if (word == "VmHWM:" && status >> kb) return kb;
  }
  throw std::runtime_error("/proc/self/status tells no peak of the memory");
}

/// How far the peak memory of the process rises above what it holds at the making. Linux lets a process
/// forget its earlier peak (proc(5), clear_refs).
class MemoryGrowth {
 public:
  MemoryGrowth() {
    std::ofstream("/proc/self/clear_refs") << 5;
    before_ = peakMemoryKb();
  }
  double kb() const { return peakMemoryKb() - before_; }

 private:
  double before_ = 0.0;
};

/// Reports the largest of the repetitions as well, which is what counts for memory.
inline void reportLargest(benchmark::internal::Benchmark* benchmark) {
  benchmark->ComputeStatistics("max", [](const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
  });
}

/// `count` anchors on a ring of 30 m, 2 to 3 m above the floor.
inline std::shared_ptr<const map::TunnelMap> ringOfAnchors(int count) {
  auto map = std::make_shared<map::TunnelMap>();
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * kPi * i / count;
    map->anchors.push_back(
        {.id = i, .p_map = {30.0 * std::cos(angle), 30.0 * std::sin(angle), 2.0 + 0.25 * (i % 5)}});
  }
  return map;
}

/// A drive at 2 m/s round a circle of 10 m about the ring's middle.
struct CircleDrive {
  static constexpr double kRadius = 10.0;
  static constexpr double kSpeed = 2.0;

  static Pose2 pose(double seconds) {
    const double angle = kSpeed / kRadius * seconds;
    return {kRadius * std::cos(angle), kRadius * std::sin(angle), wrapAngle(angle + 0.5 * kPi)};
  }
  /// The true range, and a disturbance of a few centimetres that is the same in every run.
  static double range(const Pose2& pose, const map::Anchor& anchor, int index) {
    const Eigen::Vector3d p(pose.x, pose.y, 0.0);
    return (anchor.p_map - p).norm() + 0.03 * std::sin(1.7 * index);
  }
};

}  // namespace pos::bench
