#pragma once
/// The mapping file of a CSV import: which tables a folder holds, which columns they have, in which units.
/// docs/howto/import_csv.md shows how to write one.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pos/core/error.hpp"
#include "pos/core/measurement.hpp"
#include "pos/core/stamp.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// What a field measures; decides which units it may have. Plain = a number without a unit (ids, counts).
enum class Quantity { Plain, Time, Length, Angle, AngularRate, Speed, Acceleration, Power };

/// SI units per one `unit` (1 dBm stays 1 dBm), or nothing when `unit` does not measure `quantity`.
std::optional<double> unitFactor(Quantity quantity, std::string_view unit);
/// The units that measure `quantity`; empty for Plain.
std::vector<std::string> unitsOf(Quantity quantity);

/// One field that a kind of table offers to the mapping.
struct FieldSpec {
  std::string name;
  Quantity quantity = Quantity::Plain;
  bool required = true;
};
/// A kind of table: "odometry", "ranges", ..., "truth", "anchors", "tags".
struct TableSpec {
  std::string kind;
  std::vector<FieldSpec> fields;
};
/// Kinds of the `streams:` list, and the three tables that are no streams.
const std::vector<TableSpec>& streamSpecs();
const TableSpec& truthSpec();
const TableSpec& anchorsSpec();
const TableSpec& tagsSpec();

/// Where one field comes from: a column, or one value for all rows.
struct FieldSource {
  std::string field;
  std::string column;     ///< "" when it is a constant
  double constant = 0.0;  ///< SI
  double factor = 1.0;    ///< SI per unit of the column
  std::string unit;       ///< as written; "" for plain numbers
};

/// What to do with a row that holds no usable reading (a cell that is no number, a range of 0): stop with an
/// error, or leave it out and count it.
enum class BadRows { Refuse, Skip };

/// A code of the table's fix column and what it means.
struct FixCode {
  std::int64_t code = 0;
  GnssFix::Quality quality = GnssFix::Quality::None;
};

struct TableMapping {
  std::string kind;
  std::string file;    ///< relative to the data folder
  std::string sensor;  ///< label of the measurements; by default the kind
  std::vector<FieldSource> fields;
  BadRows bad_rows = BadRows::Refuse;
  CsvHeader header = CsvHeader::Plain;
  Duration stamp_shift{0};  ///< added to every stamp of the table
  std::vector<FixCode> fix_codes;
  FilePlace place;  ///< in the mapping file
};

struct ImportMapping {
  std::string name;
  /// Calendar time of the tables' t = 0. Default 1.6e9 s (2020-09-13), so that stamps are calendar times.
  Stamp origin = stampFromSeconds(1.6e9);
  std::vector<TableMapping> streams;
  std::optional<TableMapping> truth;
  std::optional<TableMapping> anchors;
  std::optional<TableMapping> tags;
  std::vector<map::Anchor> listed_anchors;  ///< anchors written into the mapping itself
  std::vector<std::pair<TagId, Eigen::Vector3d>> listed_tags;
};

/// Reads a mapping. Unknown, missing and repeated keys, wrong types, unknown kinds and units are ConfigErrors
/// with file:line:column and the key's path.
ImportMapping readImportMapping(const std::filesystem::path& path);
/// The same from text; `file` names it in complaints.
ImportMapping parseImportMapping(const std::string& text, const std::string& file);

}  // namespace pos::io
