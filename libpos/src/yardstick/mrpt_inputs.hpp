#pragma once
/// Our map and readings as MRPT's objects.

#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBeaconRanges.h>

#include "pos/core/measurement.hpp"
#include "pos/estimation/configs.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::yardstick {

/// MRPT's grids cannot be turned, so its filter works in the frame of the grid's lower left corner. Identity
/// without a grid.
Pose2 filterFrame(const map::TunnelMap& map, const estimation::MrptMclConfig& config);

/// The maps the config uses, in the filter's frame.
mrpt::maps::CMultiMetricMap::Ptr metricMap(const map::TunnelMap& map, const estimation::MrptMclConfig& config,
                                           int beams_in_scan);

/// One range; `p_tag` is the tag on MRPT's body, whose z = 0 is the map's.
mrpt::obs::CObservationBeaconRanges::Ptr beaconObservation(const BeaconRange& range,
                                                           const Eigen::Vector3d& p_tag,
                                                           double corrected_range);
mrpt::obs::CObservation2DRangeScan::Ptr scanObservation(const Scan2D& scan, double body_height);

}  // namespace pos::yardstick
