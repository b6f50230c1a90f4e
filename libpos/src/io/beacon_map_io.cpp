#include "pos/io/beacon_map_io.hpp"

#include <mrpt/maps/CBeaconMap.h>

#include <cmath>

#include "mrpt_archive.hpp"
#include "pos/core/error.hpp"

namespace pos::io {

void saveBeaconMap(const map::TunnelMap& map, const std::string& path) {
  if (map.anchors.empty()) {
    throw ConfigError(Complaint{.what = "the map has no anchors to export",
                                .key = map.name + ".anchors",
                                .suggestion = "add the surveyed anchors to the map"});
  }
  mrpt::maps::CBeaconMap beacons;
  for (const map::Anchor& anchor : map.anchors) {
    mrpt::maps::CBeacon beacon;
    beacon.m_ID = anchor.id;
    beacon.m_typePDF = mrpt::maps::CBeacon::pdfGauss;
    beacon.m_locationGauss.mean = {anchor.p_map.x(), anchor.p_map.y(), anchor.p_map.z()};
    beacon.m_locationGauss.cov.setZero();
    for (int axis = 0; axis < 3; ++axis)
      beacon.m_locationGauss.cov(axis, axis) = anchor.survey_sigma * anchor.survey_sigma;
    beacons.push_back(beacon);
  }
  writeMapObject(beacons, path);
}

std::vector<map::Anchor> loadBeaconMap(const std::string& path) {
  const auto object = readMapObject(path, "mrpt::maps::CBeaconMap");
  const auto& beacons = dynamic_cast<const mrpt::maps::CBeaconMap&>(*object);
  std::vector<map::Anchor> anchors;
  for (const mrpt::maps::CBeacon& beacon : beacons) {
    if (beacon.m_typePDF != mrpt::maps::CBeacon::pdfGauss) {
      throw DataError(Complaint{.what = "a beacon has no single place: MRPT was still looking for it",
                                .place = {.file = path},
                                .key = "beacon " + std::to_string(beacon.m_ID),
                                .expected = "a Gaussian position"});
    }
    const auto& place = beacon.m_locationGauss;
    map::Anchor anchor;
    anchor.id = static_cast<AnchorId>(beacon.m_ID);
    anchor.p_map = {place.mean.x(), place.mean.y(), place.mean.z()};
    anchor.survey_sigma = std::sqrt((place.cov(0, 0) + place.cov(1, 1) + place.cov(2, 2)) / 3.0);
    anchors.push_back(anchor);
  }
  return anchors;
}

}  // namespace pos::io
