/// Our particle filter's hot loops beside MRPT's, on the same made-up scene: 20 000 particles about a pose in
/// a walled room, four anchors, a scan of 152 beams. Compare within one run; the counters are nanoseconds per
/// particle and range, beam or motion. One thread.
#include <tbb/global_control.h>

#include "mcl_scene.hpp"
#include "pos/estimation/scan_points.hpp"

namespace pos::bench {
namespace {

void ranges(benchmark::State& state, InstructionSet with) {
  Cloud cloud;
  estimation::RangeWeights weights(with);
  const FloatArray level = cloud.set.weight;
  const PerItem per_item;
  for (auto _ : state) {
    cloud.set.weight = level;
    for (const Eigen::Vector3d& anchor : kAnchors) {
      const Eigen::Vector3d p(anchor.x() - cloud.set.origin.x(), anchor.y() - cloud.set.origin.y(),
                              anchor.z());
      const estimation::RangeTerm term{.anchor = p, .tag = kTag, .range = rangeTo(anchor)};
      benchmark::DoNotOptimize(weights.evaluate(cloud.set, cloud.headings, term));
      weights.apply(cloud.set);
    }
    normalise(cloud.set, with);
  }
  per_item.report(state, "ns_per_particle_range", static_cast<double>(kParticles * kAnchors.size()));
}
void ranges_ours(benchmark::State& state) {
  ranges(state, bestInstructionSet());
}
BENCHMARK(ranges_ours);
void ranges_portable(benchmark::State& state) {
  ranges(state, InstructionSet::Portable);
}
BENCHMARK(ranges_portable);

void ranges_mrpt(benchmark::State& state) {
  const Cloud cloud;
  const auto map = mrpts::beacons();
  const auto observation = mrpts::ranges();
  std::vector<double> log_weight(kParticles);
  const PerItem per_item;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kParticles; ++i) {
      const Pose2 p = cloud.set.pose(i);
      log_weight[i] += map->computeObservationLikelihood(
          *observation, mrpt::poses::CPose3D(p.x, p.y, 0.0, p.yaw, 0.0, 0.0));
    }
    benchmark::DoNotOptimize(log_weight.data());
  }
  per_item.report(state, "ns_per_particle_range", static_cast<double>(kParticles * kAnchors.size()));
}
BENCHMARK(ranges_mrpt);

void scans(benchmark::State& state, InstructionSet with) {
  Cloud cloud;
  const estimation::ScanLikelihood model{.beams = kBeams};
  estimation::ScanWeights weights(room(), model, with);
  const FloatArray level = cloud.set.weight;
  const lidar::BeamPoints points = beamPoints(scan(), model);
  const PerItem per_item;
  for (auto _ : state) {
    cloud.set.weight = level;
    benchmark::DoNotOptimize(weights.evaluate(cloud.set, cloud.headings, points, 1.0));
    weights.apply(cloud.set);
  }
  per_item.report(state, "ns_per_particle_beam", static_cast<double>(kParticles * kBeams));
}
void scan_ours(benchmark::State& state) {
  scans(state, bestInstructionSet());
}
BENCHMARK(scan_ours);
void scan_portable(benchmark::State& state) {
  scans(state, InstructionSet::Portable);
}
BENCHMARK(scan_portable);

void scan_mrpt(benchmark::State& state) {
  const Cloud cloud;
  const auto map = mrpts::grid();
  const auto observation = mrpts::sweep();
  std::vector<double> log_weight(kParticles);
  const PerItem per_item;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kParticles; ++i) {
      const Pose2 p = cloud.set.pose(i);
      log_weight[i] += map->computeObservationLikelihood(
          *observation, mrpt::poses::CPose3D(p.x, p.y, 0.0, p.yaw, 0.0, 0.0));
    }
    benchmark::DoNotOptimize(log_weight.data());
  }
  per_item.report(state, "ns_per_particle_beam", static_cast<double>(kParticles * kBeams));
}
BENCHMARK(scan_mrpt);

void predict(benchmark::State& state, InstructionSet with) {
  Cloud cloud;
  std::uint64_t step = 0;
  const PerItem per_item;
  for (auto _ : state) propagate(cloud.set, cloud.headings, kMotion, 1, step++, with);
  per_item.report(state, "ns_per_particle", static_cast<double>(kParticles));
}
void predict_ours(benchmark::State& state) {
  predict(state, bestInstructionSet());
}
BENCHMARK(predict_ours);
void predict_portable(benchmark::State& state) {
  predict(state, InstructionSet::Portable);
}
BENCHMARK(predict_portable);

void predict_mrpt(benchmark::State& state) {
  mrpts::Filter filter(kParticles);
  mrpts::fill(filter, Cloud());
  const mrpt::obs::CActionCollection action = mrpts::motion(1.0);
  const mrpt::bayes::CParticleFilter::TParticleFilterOptions options;
  const PerItem per_item;
  for (auto _ : state) filter.prediction_and_update_pfStandardProposal(&action, nullptr, options);
  per_item.report(state, "ns_per_particle", static_cast<double>(kParticles));
}
BENCHMARK(predict_mrpt);

void resample_ours(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const Cloud cloud(count);
  filters::ParticleSet set = cloud.set;
  filters::SystematicResampler resampler;
  RandomStream random(5, 5);
  const PerItem per_item;
  for (auto _ : state) {
    set.weight = cloud.set.weight;
    resampler.resample(set, count, random);
  }
  per_item.report(state, "ns_per_particle", static_cast<double>(count));
}
BENCHMARK(resample_ours)->Arg(kParticles)->Arg(kMillion);

void resample_mrpt(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const Cloud cloud(count);
  mrpts::Filter filter(count);
  std::vector<double> log_weight(count);
  for (std::size_t i = 0; i < count; ++i) log_weight[i] = std::log(static_cast<double>(cloud.set.weight[i]));
  mrpt::bayes::CParticleFilter::TParticleFilterOptions options;
  options.resamplingMethod = mrpt::bayes::CParticleFilter::prSystematic;
  const PerItem per_item;
  for (auto _ : state) {
    for (std::size_t i = 0; i < count; ++i) filter.m_particles[i].log_w = log_weight[i];
    filter.performResampling(options);
  }
  per_item.report(state, "ns_per_particle", static_cast<double>(count));
}
BENCHMARK(resample_mrpt)->Arg(kParticles)->Arg(kMillion);

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
