#include "mrpt_inputs.hpp"

#include <mrpt/maps/CBeaconMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>

#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"

namespace pos::yardstick {
namespace {

mrpt::maps::CBeaconMap::Ptr beaconMap(const map::TunnelMap& map, const Pose2& T_map_filter,
                                      double range_sigma) {
  auto beacons = mrpt::maps::CBeaconMap::Create();
  for (const map::Anchor& anchor : map.anchors) {
    const Eigen::Vector2d p = inverse(T_map_filter) * Eigen::Vector2d(anchor.p_map.head<2>());
    mrpt::maps::CBeacon beacon;
    beacon.m_ID = anchor.id;
    beacon.m_typePDF = mrpt::maps::CBeacon::pdfGauss;
    beacon.m_locationGauss.mean = mrpt::poses::CPoint3D(p.x(), p.y(), anchor.p_map.z());
    beacon.m_locationGauss.cov.setZero();
    for (int i = 0; i < 3; ++i)
      beacon.m_locationGauss.cov(i, i) = std::max(1e-6, std::pow(anchor.survey_sigma, 2));
    beacons->push_back(beacon);
  }
  beacons->likelihoodOptions.rangeStd = static_cast<float>(range_sigma);
  return beacons;
}

mrpt::maps::COccupancyGridMap2D::Ptr gridMap(const map::OccupancyGrid& grid, int decimation) {
  auto cells = mrpt::maps::COccupancyGridMap2D::Create();
  const auto resolution = static_cast<float>(grid.resolution);
  cells->setSize(0.0F, resolution * static_cast<float>(grid.columns), 0.0F,
                 resolution * static_cast<float>(grid.rows), resolution, 0.5F);
  ensure(
      static_cast<int>(cells->getSizeX()) >= grid.columns && static_cast<int>(cells->getSizeY()) >= grid.rows,
      "MRPT made a smaller grid than asked");
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const std::uint8_t percent = grid.at(column, row);
      if (percent <= 100) cells->setCell(column, row, 1.0F - 0.01F * static_cast<float>(percent));
    }
  }
  cells->likelihoodOptions.LF_decimation = static_cast<std::uint32_t>(std::max(1, decimation));
  return cells;
}

}  // namespace

Pose2 filterFrame(const map::TunnelMap& map, const estimation::MrptMclConfig& config) {
  if (!config.use_scans || !map.grid) return {};
  return map.grid->T_map_grid * Pose2{map.grid->x_min, map.grid->y_min, 0.0};
}

mrpt::maps::CMultiMetricMap::Ptr metricMap(const map::TunnelMap& map, const estimation::MrptMclConfig& config,
                                           int beams_in_scan) {
  auto maps = mrpt::maps::CMultiMetricMap::Create();
  if (config.use_scans) maps->maps.push_back(gridMap(*map.grid, beams_in_scan / config.beams));
  if (config.use_ranges) maps->maps.push_back(beaconMap(map, filterFrame(map, config), config.range_sigma));
  return maps;
}

mrpt::obs::CObservationBeaconRanges::Ptr beaconObservation(const BeaconRange& range,
                                                           const Eigen::Vector3d& p_tag,
                                                           double corrected_range) {
  auto observation = mrpt::obs::CObservationBeaconRanges::Create();
  observation->minSensorDistance = 0.0F;
  observation->maxSensorDistance = 1e4F;
  mrpt::obs::CObservationBeaconRanges::TMeasurement one;
  one.beaconID = range.anchor;
  one.sensedDistance = static_cast<float>(corrected_range);
  one.sensorLocationOnRobot = mrpt::poses::CPoint3D(p_tag.x(), p_tag.y(), p_tag.z());
  observation->sensedData.push_back(one);
  return observation;
}

mrpt::obs::CObservation2DRangeScan::Ptr scanObservation(const Scan2D& scan, double body_height) {
  auto observation = mrpt::obs::CObservation2DRangeScan::Create();
  const std::size_t n = scan.ranges.size();
  const double span = scan.angle_step * static_cast<double>(n - 1);
  observation->aperture = static_cast<float>(std::abs(span));
  observation->rightToLeft = scan.angle_step >= 0.0;
  observation->maxRange = static_cast<float>(scan.range_max);
  observation->resizeScan(n);
  for (std::size_t i = 0; i < n; ++i) {
    observation->setScanRange(i, scan.ranges[i]);
    observation->setScanRangeValidity(i, scan.valid[i] != 0);
  }
  // MRPT's scans are centred on the sensor's x axis.
  const double middle = scan.angle_first + 0.5 * span;
  const Eigen::Vector3d& p = scan.T_body_sensor.translation;
  observation->sensorPose = mrpt::poses::CPose3D(p.x(), p.y(), p.z() + body_height,
                                                 wrapAngle(scan.T_body_sensor.yaw() + middle), 0.0, 0.0);
  return observation;
}

}  // namespace pos::yardstick
