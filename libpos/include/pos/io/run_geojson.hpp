#pragma once
/// The tracks of a finished run as GeoJSON (RFC 7946), for QGIS and other map tools.
/// docs/formats/trajectories.md.

#include <cstdint>
#include <filesystem>
#include <optional>

#include "pos/core/estimate.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::io {

struct TrackOptions {
  std::optional<Truth> truth = {};
  /// Coordinates in degrees by the tie of this map; absent: metres of the map, as in mapGeoJson.
  std::optional<map::GeodeticOrigin> origin = {};
};

/// One feature a track, a line with its stamps beside it, read from `folder` (<estimator>.csv) row by row.
/// Returns the number of points. Throws DataError for a folder that holds no run, or a damaged table.
std::uint64_t writeRunGeoJson(const std::filesystem::path& folder, const std::filesystem::path& out,
                              const TrackOptions& options);

}  // namespace pos::io
