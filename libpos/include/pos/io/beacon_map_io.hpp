#pragma once
/// Radio anchors as an MRPT beacon map.

#include <string>
#include <vector>

#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// Writes MRPT's CBeaconMap (`.beaconmap`, gzip): one Gaussian beacon per anchor with survey_sigma on each
/// axis. Lost, as MRPT has no room: names and range biases. Throws ConfigError without anchors, DataError
/// when the file cannot be written.
void saveBeaconMap(const map::TunnelMap& map, const std::string& path);

/// The Gaussian beacons of such a file. Throws DataError for a missing, damaged or other file, or a beacon
/// that is not Gaussian.
std::vector<map::Anchor> loadBeaconMap(const std::string& path);

}  // namespace pos::io
