/// Questions to a map of 1e5 centreline segments (1000 roadways on three levels), each beside a walk through
/// all segments. `bytes_per_segment` is what the network takes beside the map itself.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <cmath>
#include <memory>

#include "pos/core/angle.hpp"
#include "pos/core/random.hpp"
#include "pos/map/lock_intervals.hpp"

namespace {

using pos::map::Network;

pos::map::Roadway roadway(int r, int points) {
  pos::RandomStream random(1, static_cast<std::uint64_t>(r));
  pos::map::Roadway roadway;
  roadway.id = "R" + std::to_string(r);
  Eigen::Vector3d p(random.uniform(-3000.0, 3000.0), random.uniform(-3000.0, 3000.0), -30.0 * (r % 3));
  double heading = random.uniform(-pos::kPi, pos::kPi);
  for (int i = 0; i < points; ++i) {
    const double arc = random.bernoulli(0.2) ? random.uniform(-0.5, 0.5) : 0.0;
    roadway.centreline.push_back({.p_map = p, .arc = arc});
    heading += 0.5 * arc;
    p += Eigen::Vector3d(20.0 * std::cos(heading), 20.0 * std::sin(heading), random.uniform(-0.5, 0.5));
    heading += 0.5 * arc + random.uniform(-0.05, 0.05);
  }
  return roadway;
}

std::shared_ptr<const pos::map::TunnelMap> field() {
  static const auto map = [] {
    pos::map::TunnelMap field{.name = "field"};
    for (int r = 0; r < 1000; ++r) field.roadways.push_back(roadway(r, 101));
    return std::make_shared<const pos::map::TunnelMap>(std::move(field));
  }();
  return map;
}

const Network& network() {
  static const Network network(field());
  return network;
}

/// A point in a roadway, as a vehicle's estimate is: up to 3 m off the middle.
pos::map::TunnelPoint somewhere(pos::RandomStream& random) {
  const auto r = static_cast<std::size_t>(random.bits() % 1000);
  return {r, random.uniform(0.0, network().centreline(r).length() - 60.0), random.uniform(-3.0, 3.0), 1.5};
}

std::vector<Eigen::Vector3d> points() {
  pos::RandomStream random(2, 0);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 4096; ++i) points.push_back(network().toMap(somewhere(random)));
  return points;
}

void project(benchmark::State& state) {
  const auto all = points();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(network().project(all[i++ % all.size()]));
}
BENCHMARK(project);

void projectThroughAllSegments(benchmark::State& state) {
  const auto all = points();
  std::size_t i = 0;
  for (auto _ : state) {
    double best = 1e9;
    for (std::size_t r = 0; r < 1000; ++r) {
      const auto foot = network().centreline(r).foot(all[i % all.size()]);
      best = std::min(best, std::hypot(foot.offset, foot.beyond, foot.height));
    }
    benchmark::DoNotOptimize(best);
    ++i;
  }
}
BENCHMARK(projectThroughAllSegments);

void lineOfSight60m(benchmark::State& state) {
  pos::RandomStream random(3, 0);
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> lines;
  for (int i = 0; i < 4096; ++i) {
    auto a = somewhere(random);
    a.offset = 0.0;
    auto b = a;
    b.chainage += 60.0;
    lines.emplace_back(network().toMap(a), network().toMap(b));
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [a, b] = lines[i++ % lines.size()];
    benchmark::DoNotOptimize(network().inSight(a, b));
  }
}
BENCHMARK(lineOfSight60m);

void buildNetwork(benchmark::State& state) {
  const auto map = field();
  std::size_t bytes = 0;
  for (auto _ : state) {
    const std::size_t before = mallinfo2().uordblks + mallinfo2().hblkhd;
    const Network built(map);
    bytes = mallinfo2().uordblks + mallinfo2().hblkhd - before;
    benchmark::DoNotOptimize(&built);
  }
  state.counters["bytes_per_segment"] = static_cast<double>(bytes) / 1e5;
}
BENCHMARK(buildNetwork)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
