#pragma once
/// The scene of the particle filters' benchmarks: a pose in a walled room, four anchors, a scan of 152 beams,
/// for ours and for MRPT's filter.

#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/maps/CBeaconMap.h>
#include <mrpt/maps/CMultiMetricMap.h>
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
#include "pos/filters/propagation.hpp"
#include "support.hpp"

namespace pos::bench {

inline constexpr std::size_t kParticles = 20000;
inline constexpr std::size_t kMillion = 1000000;
inline constexpr int kBeams = 152;
inline const Pose2 kPose{6.0, 4.0, 0.4};
inline const Eigen::Vector3d kTag{0.2, 0.0, 1.1};
inline const std::vector<Eigen::Vector3d> kAnchors{
    {-2.0, -3.0, 2.0}, {14.0, -2.0, 2.5}, {13.0, 11.0, 1.5}, {-3.0, 10.0, 3.0}};

inline bool isWall(double x, double y) {
  const bool inside = x > 0.0 && x < 12.0 && y > 0.0 && y < 8.0;
  const bool block = x > 7.5 && x < 9.0 && y > 5.5 && y < 7.5;
  return !inside || block;
}

inline map::OccupancyGrid room() {
  map::OccupancyGrid grid{.T_map_grid = {},
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

inline Scan2D scan() {
  Scan2D scan;
  scan.angle_first = -0.5 * kPi;
  scan.angle_step = kPi / (kBeams - 1);
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

inline double rangeTo(const Eigen::Vector3d& anchor) {
  return (anchor - Eigen::Vector3d(kPose.x, kPose.y, 1.1)).norm();
}

/// A tracking cloud (10 cm, 3 degrees) with weights that differ, so that no branch becomes predictable.
struct Cloud {
  filters::ParticleSet set;
  filters::HeadingTable headings;

  explicit Cloud(std::size_t count = kParticles) {
    RandomStream random(1, 1);
    const Vector<3> variance(0.01, 0.01, 0.0027);
    set = estimation::gaussianParticles({kPose, variance.asDiagonal()}, count, random);
    for (float& weight : set.weight) weight = static_cast<float>(std::exp(random.normal()));
    fillHeadings(headings, set);
  }
};

/// The small motion of a step, with its noise.
inline const filters::NoisyStep kMotion{{0.01, 0.0, 0.001}, {0.003, 0.001, 0.001}};

namespace mrpts {

using Filter = mrpt::slam::CMonteCarloLocalization2D;

inline mrpt::maps::CBeaconMap::Ptr beacons() {
  auto map = mrpt::maps::CBeaconMap::Create();
  for (std::size_t k = 0; k < kAnchors.size(); ++k) {
    mrpt::maps::CBeacon beacon;
    beacon.m_ID = static_cast<int>(k);
    beacon.m_typePDF = mrpt::maps::CBeacon::pdfGauss;
    beacon.m_locationGauss.mean = mrpt::poses::CPoint3D(kAnchors[k].x(), kAnchors[k].y(), kAnchors[k].z());
    beacon.m_locationGauss.cov.setDiagonal(3, 1e-6);
    map->push_back(beacon);
  }
  return map;
}

inline mrpt::obs::CObservationBeaconRanges::Ptr ranges() {
  auto observation = mrpt::obs::CObservationBeaconRanges::Create();
  observation->minSensorDistance = 0.0F;
  observation->maxSensorDistance = 100.0F;
  for (std::size_t k = 0; k < kAnchors.size(); ++k) {
    mrpt::obs::CObservationBeaconRanges::TMeasurement one;
    one.beaconID = static_cast<std::int32_t>(k);
    one.sensedDistance = static_cast<float>(rangeTo(kAnchors[k]));
    one.sensorLocationOnRobot = mrpt::poses::CPoint3D(kTag.x(), kTag.y(), kTag.z());
    observation->sensedData.push_back(one);
  }
  return observation;
}

inline mrpt::maps::COccupancyGridMap2D::Ptr grid() {
  const map::OccupancyGrid cells = room();
  auto map = mrpt::maps::COccupancyGridMap2D::Create(-1.0F, 13.0F, -1.0F, 9.0F, 0.05F);
  for (int row = 0; row < cells.rows; ++row) {
    for (int column = 0; column < cells.columns; ++column) {
      map->setCell(column, row, cells.at(column, row) == 100 ? 0.0F : 1.0F);
    }
  }
  map->likelihoodOptions.LF_decimation = 1;
  return map;
}

inline mrpt::obs::CObservation2DRangeScan::Ptr sweep() {
  const Scan2D reading = scan();
  auto observation = mrpt::obs::CObservation2DRangeScan::Create();
  observation->aperture = static_cast<float>(kPi);
  observation->rightToLeft = true;
  observation->maxRange = 30.0F;
  observation->resizeScan(kBeams);
  for (std::size_t i = 0; i < kBeams; ++i) {
    observation->setScanRange(i, reading.ranges[i]);
    observation->setScanRangeValidity(i, true);
  }
  return observation;
}

inline void fill(Filter& filter, const Cloud& cloud) {
  for (std::size_t i = 0; i < cloud.set.size(); ++i) {
    const Pose2 p = cloud.set.pose(i);
    filter.m_particles[i].d = mrpt::math::TPose2D(p.x, p.y, p.yaw);
  }
}

/// The motion of kMotion, forward or back.
inline mrpt::obs::CActionCollection motion(double sign) {
  mrpt::poses::CPosePDFGaussian change;
  const Pose2& step = kMotion.displacement;
  change.mean = mrpt::poses::CPose2D(sign * step.x, sign * step.y, sign * step.yaw);
  change.cov.setZero();
  for (int k = 0; k < 3; ++k) change.cov(k, k) = kMotion.sigma[k] * kMotion.sigma[k];
  mrpt::obs::CActionRobotMovement2D movement;
  movement.motionModelConfiguration.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
  movement.poseChange = mrpt::poses::CPosePDFGaussian::Create(change);
  mrpt::obs::CActionCollection action;
  action.insert(movement);
  return action;
}

}  // namespace mrpts
}  // namespace pos::bench
