#pragma once
/// A folder of CSV tables as measurements, by a mapping file (pos/io/import_mapping.hpp).

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pos/core/estimate.hpp"
#include "pos/core/measurement.hpp"
#include "pos/io/import_mapping.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// Changes made on purpose to what the tables say.
struct ImportOptions {
  /// Share of ranges replaced by range +- U(min, max), each sign as likely; never below 0.05 m. 0 .. 1.
  double range_outlier_probability = 0.0;
  double range_outlier_min_m = 1.0;
  double range_outlier_max_m = 10.0;
  std::uint64_t seed = 1;
};

/// The options themselves when they can be used; throws ConfigError naming the first thing wrong.
ImportOptions validated(const ImportOptions& options);

/// What one table gave.
struct TableCount {
  std::string kind;
  std::string file;
  std::size_t rows = 0;            ///< taken
  std::size_t skipped = 0;         ///< left out because of `bad_rows: skip`
  std::string first_skipped = {};  ///< the complaint about the first of them
};
struct ImportCounts {
  std::vector<TableCount> tables;  ///< streams in the mapping's order, then truth, anchors, tags
  std::size_t outliers_injected = 0;
  std::size_t ranges_to_unknown_anchors = 0;  ///< taken as they are; the map does not know their anchor
};

struct ImportResult {
  std::vector<Measurement>
      measurements;  ///< sorted by stamp; equal stamps in the mapping's and the table's order
  map::TunnelMap map;
  std::optional<Truth> truth;
  std::vector<std::pair<TagId, Eigen::Vector3d>> tags;  ///< m, body axes (FLU)
  ImportCounts counts;
};

/// Reads the tables of `data_dir` as the mapping says. Throws ConfigError for a bad mapping or bad options,
/// DataError for a bad table. A range's tag_body is set from `tags` when the mapping has them; a range of a
/// tag that is not among them is a DataError.
ImportResult importCsv(const std::filesystem::path& mapping, const std::filesystem::path& data_dir,
                       const ImportOptions& options = {});
ImportResult importCsv(const ImportMapping& mapping, const std::filesystem::path& data_dir,
                       const ImportOptions& options = {});

/// The ranges with outliers among them, and how many. Which ones depends only on the options and on the
/// ranges' order.
struct InjectedOutliers {
  std::vector<Measurement> measurements;
  std::size_t count = 0;
};
InjectedOutliers withRangeOutliers(std::vector<Measurement> measurements, const ImportOptions& options);

}  // namespace pos::io
