/// A whole step of the particle filter, estimator against estimator: motion, weighing by four ranges or by a
/// scan of 152 beams, and resampling at every step, with a fixed number of particles. Ours through
/// Mcl::ingest with all its checks, MRPT's through CParticleFilter::executeOn. One thread.
#include <mrpt/obs/CSensoryFrame.h>
#include <tbb/global_control.h>

#include "mcl_scene.hpp"

namespace pos::bench {
namespace {

std::shared_ptr<const map::TunnelMap> world() {
  auto map = std::make_shared<map::TunnelMap>();
  for (const Eigen::Vector3d& p : kAnchors) {
    map->anchors.push_back({.id = static_cast<AnchorId>(map->anchors.size()), .p_map = p});
  }
  map->grid = room();
  return map;
}

enum class Sensor { Ranges, Scan };

estimation::MclConfig config(Sensor sensor) {
  estimation::MclConfig config;
  config.start = {
      .mode = estimation::StartMode::Known, .pose = kPose, .position_sigma = 0.1, .yaw_sigma = 0.05};
  config.use_ranges = sensor == Sensor::Ranges;
  config.use_scans = sensor == Sensor::Scan;
  config.range.correlation_length = 0.0;  // MRPT counts every reading in full
  config.scan.correlation_length = 0.0;
  config.scan.beams = kBeams;
  config.particles = {.min = kParticles, .max = kParticles};
  config.resample_below = 1.0;
  config.odometry_noise = {.distance_per_sqrt_m = 0.03,
                           .lateral_per_sqrt_m = 0.01,
                           .yaw_per_sqrt_m = 0.01,
                           .yaw_per_sqrt_rad = 0.0,
                           .yaw_per_sqrt_s = 0.0,
                           .position_per_sqrt_s = 0.0};
  return config;
}

std::vector<Measurement> readings(Sensor sensor) {
  std::vector<Measurement> all;
  if (sensor == Sensor::Scan) {
    all.push_back({{}, "laser", scan()});
    return all;
  }
  for (std::size_t k = 0; k < kAnchors.size(); ++k) {
    BeaconRange range;
    range.anchor = static_cast<AnchorId>(k);
    range.range = rangeTo(kAnchors[k]);
    range.tag_body = kTag;
    all.push_back({{}, "uwb", range});
  }
  return all;
}

void ours(benchmark::State& state, Sensor sensor) {
  estimation::Mcl mcl(config(sensor), world());
  std::vector<Measurement> all = readings(sensor);
  Stamp stamp = stampFromSeconds(1.0);
  double sign = 1.0;
  double applied = 0.0;
  const Pose2& step = kMotion.displacement;
  const PerItem per_item;
  for (auto _ : state) {
    stamp += durationFromSeconds(0.1);
    const OdometryIncrement motion{{sign * step.x, sign * step.y, sign * step.yaw}, {}, {}};
    benchmark::DoNotOptimize(mcl.ingest({stamp, "odometry", motion}));
    for (Measurement& reading : all) {
      reading.stamp = stamp;
      if (mcl.ingest(reading).verdict == Verdict::Applied) ++applied;
    }
    sign = -sign;
  }
  per_item.report(state, "ns_per_particle", static_cast<double>(kParticles));
  state.counters["applied_share"] =
      applied / (static_cast<double>(all.size()) * static_cast<double>(state.iterations()));
}

void mrptsOwn(benchmark::State& state, Sensor sensor) {
  mrpts::Filter filter(kParticles);
  mrpts::fill(filter, Cloud());
  const auto map = mrpt::maps::CMultiMetricMap::Create();
  filter.options.metricMap = map;
  mrpt::obs::CSensoryFrame frame;
  if (sensor == Sensor::Ranges) {
    map->maps.push_back(mrpts::beacons());
    frame.insert(mrpts::ranges());
  } else {
    map->maps.push_back(mrpts::grid());
    frame.insert(mrpts::sweep());
  }
  mrpt::bayes::CParticleFilter algorithm;
  algorithm.m_options.PF_algorithm = mrpt::bayes::CParticleFilter::pfStandardProposal;
  algorithm.m_options.resamplingMethod = mrpt::bayes::CParticleFilter::prSystematic;
  algorithm.m_options.BETA = 1.0;
  const mrpt::obs::CActionCollection there = mrpts::motion(1.0);
  const mrpt::obs::CActionCollection back = mrpts::motion(-1.0);
  bool forward = true;
  const PerItem per_item;
  for (auto _ : state) {
    algorithm.executeOn(filter, forward ? &there : &back, &frame);
    forward = !forward;
  }
  per_item.report(state, "ns_per_particle", static_cast<double>(kParticles));
}

void step_ranges_ours(benchmark::State& state) {
  ours(state, Sensor::Ranges);
}
BENCHMARK(step_ranges_ours);
void step_ranges_mrpt(benchmark::State& state) {
  mrptsOwn(state, Sensor::Ranges);
}
BENCHMARK(step_ranges_mrpt);
void step_scan_ours(benchmark::State& state) {
  ours(state, Sensor::Scan);
}
BENCHMARK(step_scan_ours);
void step_scan_mrpt(benchmark::State& state) {
  mrptsOwn(state, Sensor::Scan);
}
BENCHMARK(step_scan_mrpt);

}  // namespace
}  // namespace pos::bench

int main(int argc, char** argv) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
