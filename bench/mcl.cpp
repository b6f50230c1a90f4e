/// Our particle filter's hot loops beside MRPT's, on the same made-up scene: 20 000 particles about a pose in
/// a walled room, four anchors, a scan of 152 beams. Compare within one run; the counters are nanoseconds per
/// particle and range, beam or motion.
#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/maps/CBeaconMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBeaconRanges.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include <cmath>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/estimation/mcl.hpp"
#include "pos/estimation/particle_start.hpp"
#include "pos/estimation/scan_points.hpp"
#include "pos/filters/fast_math.hpp"
#include "pos/filters/propagation.hpp"
#include "support.hpp"

namespace {

constexpr std::size_t kParticles = 20000;
constexpr int kBeams = 152;
const pos::Pose2 kPose{6.0, 4.0, 0.4};
const std::vector<Eigen::Vector3d> kAnchors{
    {-2.0, -3.0, 2.0}, {14.0, -2.0, 2.5}, {13.0, 11.0, 1.5}, {-3.0, 10.0, 3.0}};

bool isWall(double x, double y) {
  const bool inside = x > 0.0 && x < 12.0 && y > 0.0 && y < 8.0;
  const bool block = x > 7.5 && x < 9.0 && y > 5.5 && y < 7.5;
  return !inside || block;
}

pos::map::OccupancyGrid room() {
  pos::map::OccupancyGrid grid{.T_map_grid = {},
                               .x_min = -1.0,
                               .y_min = -1.0,
                               .resolution = 0.05,
                               .columns = 280,
                               .rows = 200,
                               .occupancy = {}};
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      grid.occupancy.push_back(isWall(-1.0 + 0.05 * (column + 0.5), -1.0 + 0.05 * (row + 0.5)) ? 100 : 0);
    }
  }
  return grid;
}

pos::Scan2D scan() {
  pos::Scan2D scan;
  scan.angle_first = -0.5 * pos::kPi;
  scan.angle_step = pos::kPi / (kBeams - 1);
  scan.range_max = 30.0;
  for (int i = 0; i < kBeams; ++i) {
    const double angle = kPose.yaw + scan.angle_first + i * scan.angle_step;
    double range = 0.0;
    while (!isWall(kPose.x + range * std::cos(angle), kPose.y + range * std::sin(angle))) range += 0.01;
    scan.ranges.push_back(static_cast<float>(range));
    scan.valid.push_back(1);
  }
  return scan;
}

/// A tracking cloud (10 cm, 3 degrees) with weights that differ, so that no branch becomes predictable.
struct Cloud {
  pos::filters::ParticleSet set;
  std::vector<float> cosine;
  std::vector<float> sine;

  Cloud() {
    pos::RandomStream random(1, 1);
    const pos::Vector<3> variance(0.01, 0.01, 0.0027);
    set = pos::estimation::gaussianParticles({kPose, variance.asDiagonal()}, kParticles, random);
    for (std::size_t i = 0; i < kParticles; ++i) {
      set.log_weight[i] = static_cast<float>(random.normal(-9.9, 1.0));
      cosine.push_back(std::cos(set.yaw[i]));
      sine.push_back(std::sin(set.yaw[i]));
    }
  }
};

void ranges_ours(benchmark::State& state) {
  Cloud cloud;
  pos::estimation::RangeWeights weights;
  const std::vector<float> level = cloud.set.log_weight;
  const pos::Pose2 truth = kPose;
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    cloud.set.log_weight = level;
    for (const Eigen::Vector3d& anchor : kAnchors) {
      const Eigen::Vector3d p(anchor.x() - cloud.set.origin.x(), anchor.y() - cloud.set.origin.y(),
                              anchor.z());
      const double range = (anchor - Eigen::Vector3d(truth.x, truth.y, 1.1)).norm();
      const pos::estimation::RangeTerm term{.anchor = p, .tag = {0.2, 0.0, 1.1}, .range = range};
      benchmark::DoNotOptimize(weights.evaluate(cloud.set, {cloud.cosine, cloud.sine}, term));
      weights.apply(cloud.set);
    }
    pos::filters::normalise(cloud.set.log_weight);
  }
  per_item.report(state, "ns_per_particle_range", static_cast<double>(kParticles * kAnchors.size()));
}
BENCHMARK(ranges_ours);

void ranges_mrpt(benchmark::State& state) {
  const Cloud cloud;
  mrpt::maps::CBeaconMap map;
  mrpt::obs::CObservationBeaconRanges observation;
  observation.minSensorDistance = 0.0F;
  observation.maxSensorDistance = 100.0F;
  for (std::size_t k = 0; k < kAnchors.size(); ++k) {
    const Eigen::Vector3d& a = kAnchors[k];
    mrpt::maps::CBeacon beacon;
    beacon.m_ID = static_cast<int>(k);
    beacon.m_typePDF = mrpt::maps::CBeacon::pdfGauss;
    beacon.m_locationGauss.mean = mrpt::poses::CPoint3D(a.x(), a.y(), a.z());
    beacon.m_locationGauss.cov.setDiagonal(3, 1e-6);
    map.push_back(beacon);
    mrpt::obs::CObservationBeaconRanges::TMeasurement one;
    one.beaconID = static_cast<std::int32_t>(k);
    one.sensedDistance = static_cast<float>((a - Eigen::Vector3d(kPose.x, kPose.y, 1.1)).norm());
    one.sensorLocationOnRobot = mrpt::poses::CPoint3D(0.2, 0.0, 1.1);
    observation.sensedData.push_back(one);
  }
  std::vector<double> log_weight(kParticles);
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kParticles; ++i) {
      const pos::Pose2 p = cloud.set.pose(i);
      log_weight[i] +=
          map.computeObservationLikelihood(observation, mrpt::poses::CPose3D(p.x, p.y, 0.0, p.yaw, 0.0, 0.0));
    }
    benchmark::DoNotOptimize(log_weight.data());
  }
  per_item.report(state, "ns_per_particle_range", static_cast<double>(kParticles * kAnchors.size()));
}
BENCHMARK(ranges_mrpt);

void scan_ours(benchmark::State& state) {
  Cloud cloud;
  const pos::estimation::ScanLikelihood model{.beams = kBeams};
  pos::estimation::ScanWeights weights(room(), model);
  const std::vector<float> level = cloud.set.log_weight;
  const pos::lidar::BeamPoints points = beamPoints(scan(), model);
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    cloud.set.log_weight = level;
    benchmark::DoNotOptimize(weights.evaluate(cloud.set, {cloud.cosine, cloud.sine}, points, 1.0));
    weights.apply(cloud.set);
    pos::filters::normalise(cloud.set.log_weight);
  }
  per_item.report(state, "ns_per_particle_beam", static_cast<double>(kParticles * kBeams));
}
BENCHMARK(scan_ours);

void scan_mrpt(benchmark::State& state) {
  const Cloud cloud;
  const pos::map::OccupancyGrid grid = room();
  const pos::Scan2D reading = scan();
  mrpt::maps::COccupancyGridMap2D map(-1.0F, 13.0F, -1.0F, 9.0F, 0.05F);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      map.setCell(column, row, grid.at(column, row) == 100 ? 0.0F : 1.0F);
    }
  }
  map.likelihoodOptions.LF_decimation = 1;
  mrpt::obs::CObservation2DRangeScan observation;
  observation.aperture = static_cast<float>(pos::kPi);
  observation.rightToLeft = true;
  observation.maxRange = 30.0F;
  observation.resizeScan(kBeams);
  for (std::size_t i = 0; i < kBeams; ++i) {
    observation.setScanRange(i, reading.ranges[i]);
    observation.setScanRangeValidity(i, true);
  }
  std::vector<double> log_weight(kParticles);
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kParticles; ++i) {
      const pos::Pose2 p = cloud.set.pose(i);
      log_weight[i] +=
          map.computeObservationLikelihood(observation, mrpt::poses::CPose3D(p.x, p.y, 0.0, p.yaw, 0.0, 0.0));
    }
    benchmark::DoNotOptimize(log_weight.data());
  }
  per_item.report(state, "ns_per_particle_beam", static_cast<double>(kParticles * kBeams));
}
BENCHMARK(scan_mrpt);

void predict_ours(benchmark::State& state) {
  Cloud cloud;
  const pos::filters::NoisyStep motion{{0.01, 0.0, 0.001}, {0.003, 0.001, 0.001}};
  std::uint64_t step = 0;
  const pos::bench::PerItem per_item;
  for (auto _ : state) propagate(cloud.set, motion, 1, step++);
  per_item.report(state, "ns_per_particle", static_cast<double>(kParticles));
}
BENCHMARK(predict_ours);

void predict_mrpt(benchmark::State& state) {
  const Cloud cloud;
  mrpt::slam::CMonteCarloLocalization2D filter(kParticles);
  for (std::size_t i = 0; i < kParticles; ++i) {
    const pos::Pose2 p = cloud.set.pose(i);
    filter.m_particles[i].d = mrpt::math::TPose2D(p.x, p.y, p.yaw);
  }
  mrpt::poses::CPosePDFGaussian change;
  change.mean = mrpt::poses::CPose2D(0.01, 0.0, 0.001);
  change.cov.setZero();
  change.cov(0, 0) = 9e-6;
  change.cov(1, 1) = 1e-6;
  change.cov(2, 2) = 1e-6;
  mrpt::obs::CActionRobotMovement2D movement;
  movement.motionModelConfiguration.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
  movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(change);
  mrpt::obs::CActionCollection action;
  action.insert(movement);
  mrpt::bayes::CParticleFilter::TParticleFilterOptions options;
  const pos::bench::PerItem per_item;
  for (auto _ : state) filter.prediction_and_update_pfStandardProposal(&action, nullptr, options);
  per_item.report(state, "ns_per_particle", static_cast<double>(kParticles));
}
BENCHMARK(predict_mrpt);

void resample_ours(benchmark::State& state) {
  const Cloud cloud;
  pos::filters::ParticleSet set = cloud.set;
  pos::filters::SystematicResampler resampler;
  pos::RandomStream random(5, 5);
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    set.log_weight = cloud.set.log_weight;
    resampler.resample(set, kParticles, random);
  }
  per_item.report(state, "ns_per_particle", static_cast<double>(kParticles));
}
BENCHMARK(resample_ours);

void resample_mrpt(benchmark::State& state) {
  const Cloud cloud;
  mrpt::slam::CMonteCarloLocalization2D filter(kParticles);
  mrpt::bayes::CParticleFilter::TParticleFilterOptions options;
  options.resamplingMethod = mrpt::bayes::CParticleFilter::prSystematic;
  const pos::bench::PerItem per_item;
  for (auto _ : state) {
    for (std::size_t i = 0; i < kParticles; ++i) filter.m_particles[i].log_w = cloud.set.log_weight[i];
    filter.performResampling(options);
  }
  per_item.report(state, "ns_per_particle", static_cast<double>(kParticles));
}
BENCHMARK(resample_mrpt);

}  // namespace

BENCHMARK_MAIN();
