#pragma once
/// A finished run as one MCAP file, for Foxglove, Lichtblick, Rerun, PlotJuggler and `ros2 bag`. Topics and
/// frames: docs/formats/mcap.md.

#include <cstdint>
#include <filesystem>
#include <optional>

#include "pos/core/estimate.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// What to write beside the run's own files.
struct RunExtras {
  std::optional<Truth> truth = {};
  std::optional<map::TunnelMap> map = {};
};

/// Reads `folder` (run.json, <estimator>.csv, events.csv) row by row; messages come in the order of their
/// stamps. Returns how many. Throws DataError for a folder that holds no run, or a damaged table.
std::uint64_t writeRunMcap(const std::filesystem::path& folder, const std::filesystem::path& out,
                           const RunExtras& extras);

}  // namespace pos::io
