#pragma once
/// A map from a surveyor's tables: one CSV of stations along the roadways, one of anchors, and a mapping file
/// that says which column is what in which unit. docs/howto/author_a_map.md shows one.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// Where a number comes from: a column, or one value for all rows.
struct ColumnSource {
  std::string column = {};
  std::optional<double> value = {};
  std::string unit = {};
};

/// One row a surveyed point of a centreline, in order along its roadway.
struct StationTable {
  std::string file = {};
  std::string roadway = {};  ///< column with the roadway's id
  ColumnSource x = {};
  ColumnSource y = {};
  ColumnSource z = {};
  /// Chainage as surveyed. The first one of a roadway is its chainage_start.
  std::optional<ColumnSource> station = {};
  std::optional<ColumnSource> arc = {};    ///< swept on the way to the next point
  std::optional<ColumnSource> width = {};  ///< the first row of a roadway counts
  std::optional<ColumnSource> height = {};
};

struct AnchorTable {
  std::string file = {};
  std::string id = {};                   ///< column
  std::optional<std::string> name = {};  ///< column
  ColumnSource x = {};
  ColumnSource y = {};
  ColumnSource z = {};
  std::optional<ColumnSource> survey_sigma = {};
  std::optional<ColumnSource> range_bias = {};
  std::optional<std::string> survey_date = {};  ///< column, YYYY-MM-DD
};

struct TableMapImport {
  std::string name = {};
  std::optional<map::MineGrid> mine_grid = {};  ///< the tables are in this grid
  double junction_reach = 0.5;                  ///< m, a roadway that ends this near another one joins it
  std::optional<StationTable> stations = {};
  std::optional<AnchorTable> anchors = {};
};

/// Reads a mapping. Throws ConfigError with file, line, column and key.
TableMapImport readTableMapping(const std::filesystem::path& file);
TableMapImport parseTableMapping(const std::string& text, const std::filesystem::path& file);

struct TableMap {
  map::TunnelMap map = {};
  std::size_t stations = 0;  ///< rows read
};
/// Reads the tables in `data_dir`. Throws DataError naming file, line and column of a bad cell, ConfigError
/// for a map that cannot be (coordinates of a mine grid that is not named; with file and line of the row: a
/// roadway of one station, an anchor given twice, a width that map files refuse).
TableMap mapFromTables(const TableMapImport& mapping, const std::filesystem::path& data_dir);

}  // namespace pos::io
