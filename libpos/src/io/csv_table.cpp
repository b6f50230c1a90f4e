#include "pos/io/csv_table.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace pos::io {
namespace {

std::unique_ptr<std::istream> opened(const std::filesystem::path& path) {
  auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!*file || std::filesystem::is_directory(path)) {
    throw DataError(Complaint{.what = "cannot open the table",
                              .place = {.file = path.string()},
                              .expected = "a readable CSV file",
                              .suggestion = "check the folder and the file name"});
  }
  return file;
}

}  // namespace

CsvReader::CsvReader(const std::filesystem::path& path, CsvHeader header)
    : input_(opened(path)), file_(path.string()) {
  readHeader(header);
}

CsvReader::CsvReader(std::string text, std::string name, CsvHeader header)
    : input_(std::make_unique<std::istringstream>(std::move(text))), file_(std::move(name)) {
  readHeader(header);
}

std::optional<std::size_t> CsvReader::findColumn(std::string_view name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end()) return {};
  return static_cast<std::size_t>(found - columns_.begin());
}

std::size_t CsvReader::column(std::string_view name) const {
  if (const auto found = findColumn(name)) return *found;
  throw DataError(Complaint{.what = "the table has no column '" + std::string(name) + "'",
                            .place = {.file = file_},
                            .key = std::string(name),
                            .got = "columns " + text::joined(columns_),
                            .suggestion = text::didYouMean(name, columns_)});
}

FilePlace CsvReader::place(std::size_t column) const {
  return {.file = file_, .line = line_, .column = static_cast<int>(offsets_[column]) + 1};
}

void CsvReader::refuse(std::size_t column, const std::string& what, const std::string& expected) const {
  throw DataError(Complaint{.what = what,
                            .place = place(column),
                            .key = columns_[column],
                            .got = "'" + std::string(cells_[column]) + "'",
                            .expected = expected});
}

double CsvReader::number(std::size_t column) const {
  const auto value = text::number(cells_[column]);
  if (!value) refuse(column, "the cell is not a finite number", "a number with a decimal point");
  return *value;
}

std::int64_t CsvReader::integer(std::size_t column) const {
  const auto value = text::integer(cells_[column]);
  if (!value) refuse(column, "the cell is not a whole number", "a whole number");
  return *value;
}

Duration CsvReader::duration(std::size_t column, text::TimeUnit unit) const {
  const auto value = text::duration(cells_[column], unit);
  if (!value) refuse(column, "the cell is not a time", "a number within +-4.6e9 s");
  return *value;
}

void CsvReader::readHeader(CsvHeader header) {
  if (!readLine(header)) {
    throw DataError(Complaint{.what = "the table is empty",
                              .place = {.file = file_},
                              .expected = "a header line with the column names"});
  }
  if (header == CsvHeader::Commented) {
    if (line_text_[0] != '#')
      refuseLine(0, "the header does not start with '#'", line_text_.substr(0, 40), "# and the column names");
    line_text_[0] = ' ';
  }
  split();
  for (const std::string_view name : cells_) {
    const std::size_t offset = offsets_[columns_.size()];
    if (name.empty()) refuseLine(offset, "a column has no name", "''", "a name for every column");
    if (findColumn(name)) {
      refuseLine(offset, "two columns have the same name", std::string(name), "every name once");
    }
    columns_.emplace_back(name);
  }
}

bool CsvReader::next() {
  if (!readLine()) return false;
  split();
  if (cells_.size() != columns_.size()) {
    refuseLine(0, "the row does not match the header", std::to_string(cells_.size()) + " cells",
               std::to_string(columns_.size()) + " cells: " + text::joined(columns_));
  }
  return true;
}

bool CsvReader::readLine(CsvHeader header) {
  while (std::getline(*input_, line_text_)) {
    ++line_;
    if (line_ == 1 && line_text_.starts_with("\xEF\xBB\xBF")) line_text_.erase(0, 3);
    if (line_text_.ends_with('\r')) line_text_.pop_back();
    const bool counts = header == CsvHeader::Commented || line_text_[0] != '#';
    if (!text::trimmed(line_text_).empty() && counts) return true;
  }
  if (input_->bad()) {
    throw DataError(Complaint{.what = "reading stopped half-way", .place = {.file = file_, .line = line_}});
  }
  return false;
}

void CsvReader::split() {
  cells_.clear();
  offsets_.clear();
  unquoted_.clear();
  unquoted_.reserve(line_text_.size());  // so that views into it stay valid
  for (std::size_t begin = 0; begin <= line_text_.size();) {
    const std::size_t first = std::min(line_text_.find_first_not_of(" \t", begin), line_text_.size());
    const bool quoted = first < line_text_.size() && line_text_[first] == '"';
    begin = 1 + (quoted ? quotedCell(first) : plainCell(begin));
  }
}

/// Takes the cell that starts at `begin`; gives where it ends (a comma or the end of the line).
std::size_t CsvReader::plainCell(std::size_t begin) {
  const std::size_t end = std::min(line_text_.find(',', begin), line_text_.size());
  const std::string_view raw = std::string_view(line_text_).substr(begin, end - begin);
  const std::string_view cell = text::trimmed(raw);
  if (const auto quote = cell.find('"'); quote != std::string_view::npos) {
    refuseLine(begin, "a quote inside a cell", std::string(cell),
               "quotes around the whole cell, \"\" inside");
  }
  offsets_.push_back(cell.empty() ? begin : static_cast<std::size_t>(cell.data() - line_text_.data()));
  cells_.push_back(cell);
  return end;
}

std::size_t CsvReader::quotedCell(std::size_t begin) {
  const std::size_t kept = unquoted_.size();
  std::size_t at = begin + 1;
  for (;; ++at) {
    if (at >= line_text_.size())
      refuseLine(begin, "a quote is not closed on its line", "", "a closing quote");
    if (line_text_[at] == '"' && (at + 1 >= line_text_.size() || line_text_[at + 1] != '"')) break;
    if (line_text_[at] == '"') ++at;
    unquoted_ += line_text_[at];
  }
  const std::size_t end = std::min(line_text_.find_first_not_of(" \t", at + 1), line_text_.size());
  if (end < line_text_.size() && line_text_[end] != ',') {
    refuseLine(end, "text after a closing quote", line_text_.substr(end), "a comma or the end of the line");
  }
  offsets_.push_back(begin);
  cells_.push_back(std::string_view(unquoted_).substr(kept));
  return end;
}

void CsvReader::refuseLine(std::size_t offset, const std::string& what, const std::string& got,
                           const std::string& expected) const {
  throw DataError(Complaint{.what = what,
                            .place = {.file = file_, .line = line_, .column = static_cast<int>(offset) + 1},
                            .got = got,
                            .expected = expected});
}

}  // namespace pos::io
