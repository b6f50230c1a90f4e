#include "import_table.hpp"

#include <limits>

namespace pos::io {
namespace {

text::TimeUnit timeUnit(std::string_view unit) {
  if (unit == "ms") return text::TimeUnit::Milliseconds;
  if (unit == "us") return text::TimeUnit::Microseconds;
  if (unit == "ns") return text::TimeUnit::Nanoseconds;
  return text::TimeUnit::Seconds;
}

}  // namespace

ImportTable::ImportTable(const TableMapping& mapping, const std::filesystem::path& data_dir, Stamp origin)
    : mapping_(mapping), csv_(data_dir / mapping.file, mapping.header), origin_(origin) {
  for (const FieldSource& source : mapping.fields) {
    if (source.column.empty()) continue;
    const std::size_t column = csv_.column(source.column);
    if (source.field != "stamp") continue;
    stamp_column_ = column;
    stamp_unit_ = timeUnit(source.unit);
  }
}

std::optional<ImportTable::Field> ImportTable::findField(std::string_view name) const {
  for (const FieldSource& source : mapping_.fields) {
    if (source.field != name) continue;
    Field field{source.field, {}, source.constant, source.factor};
    if (!source.column.empty()) field.column = csv_.column(source.column);
    return field;
  }
  return {};
}

ImportTable::Field ImportTable::field(std::string_view name) const {
  const auto found = findField(name);
  ensure(found.has_value(), "a required field is not in the table's mapping");
  return *found;
}

double ImportTable::number(const Field& field) const {
  return field.column ? field.factor * csv_.number(*field.column) : field.constant;
}

std::optional<double> ImportTable::number(const std::optional<Field>& field) const {
  if (!field || (field->column && csv_.cell(*field->column).empty())) return {};
  return number(*field);
}

std::int64_t ImportTable::integer(const Field& field) const {
  if (field.column) return csv_.integer(*field.column);
  const auto value = text::integer(text::shortest(field.constant));
  if (!value) {
    refuse(field, "the field's value is not a whole number", text::shortest(field.constant),
           "a whole number");
  }
  return *value;
}

std::int32_t ImportTable::id(const Field& field) const {
  using Limits = std::numeric_limits<std::int32_t>;
  const std::int64_t value = integer(field);
  if (value < Limits::min() || value > Limits::max()) {
    refuse(field, "the number is too large for an id", std::to_string(value), "a 32-bit integer");
  }
  return static_cast<std::int32_t>(value);
}

Stamp ImportTable::stamp() const {
  return origin_ + mapping_.stamp_shift + csv_.duration(stamp_column_, stamp_unit_);
}

std::optional<Duration> ImportTable::duration(const std::optional<Field>& field) const {
  const auto value = number(field);
  if (!value) return {};
  if (!(*value >= 0.0 && *value < 1e9)) {
    refuse(*field, "the interval is negative or too long", text::shortest(*value) + " s", "0 .. 1e9 s");
  }
  return durationFromSeconds(*value);
}

void ImportTable::refuse(const Field& field, const std::string& what, const std::string& got,
                         const std::string& expected) const {
  const FilePlace place =
      field.column ? csv_.place(*field.column) : FilePlace{.file = csv_.file(), .line = csv_.line()};
  throw DataError(Complaint{.what = what,
                            .place = place,
                            .key = field.column ? csv_.columns()[*field.column] : std::string(field.name),
                            .got = got,
                            .expected = expected});
}

TableCount forEachRow(ImportTable& table, const std::function<void()>& take) {
  TableCount count{.kind = table.mapping().kind, .file = table.mapping().file};
  while (table.next()) {
    try {
      take();
      ++count.rows;
    } catch (const DataError& error) {
      if (table.mapping().bad_rows == BadRows::Refuse) throw;
      if (count.skipped++ == 0) count.first_skipped = error.what();
    }
  }
  return count;
}

}  // namespace pos::io
