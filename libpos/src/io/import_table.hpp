#pragma once
/// One CSV table seen through its mapping: fields in SI instead of columns. Internal to the import.

#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

#include "pos/core/measurement.hpp"
#include "pos/io/csv_import.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/import_mapping.hpp"

namespace pos::io {

class ImportTable {
 public:
  /// Opens the table and looks up its columns; throws DataError when one is missing.
  ImportTable(const TableMapping& mapping, const std::filesystem::path& data_dir, Stamp origin);

  /// One field of the current row; a handle that is cheap to keep.
  struct Field {
    std::string_view name;
    std::optional<std::size_t> column;
    double constant = 0.0;
    double factor = 1.0;
  };
  /// The mapping's field, which the mapping reader has made sure of.
  Field field(std::string_view name) const;
  std::optional<Field> findField(std::string_view name) const;

  bool next() { return csv_.next(); }
  const CsvReader& csv() const { return csv_; }
  const TableMapping& mapping() const { return mapping_; }

  /// Values of the current row, SI. Throw DataError for a cell that is no number.
  double number(const Field& field) const;
  std::int64_t integer(const Field& field) const;
  std::int32_t id(const Field& field) const;
  Stamp stamp() const;
  /// Nothing when the mapping has no such field or the cell is empty.
  std::optional<double> number(const std::optional<Field>& field) const;
  std::optional<Duration> duration(const std::optional<Field>& field) const;

  /// A complaint about the current row, placed at the field's cell where it has one.
  [[noreturn]] void refuse(const Field& field, const std::string& what, const std::string& got,
                           const std::string& expected) const;

 private:
  const TableMapping& mapping_;
  CsvReader csv_;
  Stamp origin_;
  std::size_t stamp_column_ = 0;
  text::TimeUnit stamp_unit_ = text::TimeUnit::Seconds;
};

/// Calls `take` for every row, and counts. A DataError thrown by `take` skips the row if the mapping says so.
TableCount forEachRow(ImportTable& table, const std::function<void()>& take);

using TagPlaces = std::vector<std::pair<TagId, Eigen::Vector3d>>;
/// The function that turns the current row of a stream's table into a reading.
std::function<Reading()> rowReader(const ImportTable& table, const TagPlaces& tags);

/// The row of a truth table as a pose.
std::function<TruthPose()> truthReader(const ImportTable& table);

}  // namespace pos::io
