#pragma once
/// Strict reading of CSV tables, row by row.
///
/// A table is a header line with the column names, then rows with as many cells; cells are separated by
/// commas, blanks around a cell do not count, a cell in double quotes may hold commas and "" for a quote.
/// Line ends are LF or CRLF; empty lines and lines that start with '#' are skipped; a byte-order mark is
/// skipped. Everything else is a DataError with file:line:column. Decimal point only, whatever the locale.
/// Some programs write the header itself behind a '#': CsvHeader::Commented reads those.

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pos/core/error.hpp"
#include "pos/core/stamp.hpp"
#include "pos/io/text.hpp"

namespace pos::io {

enum class CsvHeader {
  Plain,
  Commented,  ///< the first line starts with '#', its names follow
};

class CsvReader {
 public:
  /// Opens the file and reads its header. Throws DataError when it cannot be read or has no good header.
  explicit CsvReader(const std::filesystem::path& path, CsvHeader header = CsvHeader::Plain);
  /// Reads `text` as if it were the file `name`.
  CsvReader(std::string text, std::string name, CsvHeader header = CsvHeader::Plain);

  const std::string& file() const { return file_; }
  const std::vector<std::string>& columns() const { return columns_; }
  std::optional<std::size_t> findColumn(std::string_view name) const;
  /// As above; throws DataError with the columns there are and the most similar one.
  std::size_t column(std::string_view name) const;

  /// Goes to the next row; false at the end. Throws DataError for a row that is no row.
  bool next();
  /// Line of the current row, counted from 1.
  int line() const { return line_; }
  /// The current row's cell. Valid until the next call of next().
  std::string_view cell(std::size_t column) const { return cells_[column]; }
  FilePlace place(std::size_t column) const;

  /// The cell as a finite number, a whole number, or a time since its origin; else DataError.
  double number(std::size_t column) const;
  std::int64_t integer(std::size_t column) const;
  Duration duration(std::size_t column, text::TimeUnit unit) const;

  /// A complaint about a cell of the current row.
  [[noreturn]] void refuse(std::size_t column, const std::string& what, const std::string& expected) const;

 private:
  void readHeader(CsvHeader header);
  bool readLine(CsvHeader header = CsvHeader::Plain);
  void split();
  std::size_t quotedCell(std::size_t begin);
  std::size_t plainCell(std::size_t begin);
  [[noreturn]] void refuseLine(std::size_t offset, const std::string& what, const std::string& got,
                               const std::string& expected) const;

  std::unique_ptr<std::istream> input_;
  std::string file_;
  std::vector<std::string> columns_;
  std::string line_text_;
  std::string unquoted_;  ///< quoted cells of the row without their quotes
  std::vector<std::string_view> cells_;
  std::vector<std::size_t> offsets_;  ///< where in the line each cell starts
  int line_ = 0;
};

}  // namespace pos::io
