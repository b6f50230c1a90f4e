#include "pos/io/import_mapping.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "import_yaml.hpp"
#include "pos/io/text.hpp"

namespace pos::io {
namespace {

using namespace mapping_yaml;

/// The factor to SI of a `{column|value, unit}` entry.
double factorOf(const Entry& at, const FieldSpec& spec) {
  const auto unit = find(at, "unit");
  if (spec.quantity == Quantity::Plain) {
    if (unit) refuse(*unit, "this field has no unit", "no key 'unit'");
    return 1.0;
  }
  const Keys units = unitsOf(spec.quantity);
  const std::string expected = "one of " + text::joined(units);
  const Entry entry = need(at, "unit", expected);
  const std::string name = textOf(entry, expected);
  const auto factor = unitFactor(spec.quantity, name);
  if (!factor) refuse(entry, "the unit does not fit '" + spec.name + "'", expected);
  return *factor;
}

FieldSource readField(const Entry& at, const FieldSpec& spec) {
  requireKeys(at, {"column", "value", "unit"});
  const auto column = find(at, "column");
  const auto value = find(at, "value");
  if (column.has_value() == value.has_value()) {
    refuse(at, "a field needs either a column or a value", "{column: <name>, unit: <unit>} or value:");
  }
  if (value && spec.name == "stamp") refuse(*value, "stamps need a column", "column: <name>");
  FieldSource source{
      .field = spec.name, .column = {}, .constant = 0.0, .factor = factorOf(at, spec), .unit = {}};
  if (const auto unit = find(at, "unit")) source.unit = unit->node.Scalar();
  if (column) source.column = textOf(*column, "a column's name");
  if (value) source.constant = source.factor * numberOf(*value, "a number");
  return source;
}

std::vector<FieldSource> readFields(const Entry& at, const TableSpec& spec) {
  Keys names;
  names.reserve(spec.fields.size());
  for (const FieldSpec& field : spec.fields) names.push_back(field.name);
  requireKeys(at, names);
  std::vector<FieldSource> sources;
  for (const FieldSpec& field : spec.fields) {
    const auto entry =
        field.required ? need(at, field.name, "{column: <name>, unit: <unit>}") : find(at, field.name);
    if (entry) sources.push_back(readField(*entry, field));
  }
  return sources;
}

bool has(const std::vector<FieldSource>& fields, std::string_view name) {
  return std::any_of(fields.begin(), fields.end(), [&](const FieldSource& f) { return f.field == name; });
}

BadRows readBadRows(const Entry& at) {
  const std::string word = textOf(at, "refuse or skip");
  if (word != "refuse" && word != "skip") refuse(at, "unknown word", "refuse or skip");
  return word == "skip" ? BadRows::Skip : BadRows::Refuse;
}

CsvHeader readCsvHeader(const Entry& at) {
  const std::string word = textOf(at, "plain or commented");
  if (word != "plain" && word != "commented") refuse(at, "unknown word", "plain or commented");
  return word == "commented" ? CsvHeader::Commented : CsvHeader::Plain;
}

GnssFix::Quality readQuality(const Entry& at) {
  using Quality = GnssFix::Quality;
  static const std::vector<std::pair<std::string, Quality>> kWords{{"none", Quality::None},
                                                                   {"autonomous", Quality::Autonomous},
                                                                   {"differential", Quality::Differential},
                                                                   {"rtk_float", Quality::RtkFloat},
                                                                   {"rtk_fixed", Quality::RtkFixed}};
  Keys words;
  words.reserve(kWords.size());
  for (const auto& [word, quality] : kWords) words.push_back(word);
  const std::string found = textOf(at, "one of " + text::joined(words));
  for (const auto& [word, quality] : kWords) {
    if (word == found) return quality;
  }
  refuse(at, "unknown fix quality", "one of " + text::joined(words), text::didYouMean(found, words));
}

std::vector<FixCode> readFixCodes(const Entry& at) {
  if (!at.node.IsMap()) refuse(at, "expected a map", "{<code in the table>: <quality>, ...}");
  std::vector<FixCode> codes;
  for (const auto& pair : at.node) {
    const std::string key = pair.first.IsScalar() ? pair.first.Scalar() : "";
    const auto code = text::integer(key);
    if (!code) refuse(childOf(at, key, pair.first), "a fix code is a whole number", "e.g. 4: rtk_fixed");
    codes.push_back({*code, readQuality(childOf(at, key, pair.second))});
  }
  return codes;
}

/// fix_codes and the column they explain come together.
void readGnssOptions(const Entry& at, TableMapping& table) {
  const auto codes = find(at, "fix_codes");
  if (codes.has_value() != has(table.fields, "fix_status")) {
    refuse(codes.value_or(at), "fix_codes and columns.fix_status go together", "both or neither");
  }
  if (codes) table.fix_codes = readFixCodes(*codes);
}

TableMapping readTable(const Entry& at, const TableSpec& spec, Keys allowed) {
  allowed.insert(allowed.end(), {"file", "columns", "bad_rows", "header"});
  const bool has_stamps = spec.fields.front().name == "stamp";
  if (has_stamps) allowed.emplace_back("stamp_shift_s");
  requireKeys(at, allowed);
  TableMapping table;
  table.kind = spec.kind;
  table.sensor = spec.kind;
  table.place = placeOf(at.node.Mark(), at.file);
  table.file = textOf(need(at, "file", "the table's file name in the data folder"), "a file name");
  table.fields = readFields(need(at, "columns", "the fields of the table"), spec);
  if (const auto rows = find(at, "bad_rows")) table.bad_rows = readBadRows(*rows);
  if (const auto header = find(at, "header")) table.header = readCsvHeader(*header);
  if (const auto shift = find(at, "stamp_shift_s")) {
    table.stamp_shift = secondsOf(*shift, std::chrono::seconds(1'000'000),
                                  "seconds within +-1e6, added to every stamp of the table");
  }
  return table;
}

TableMapping readStream(const Entry& at) {
  if (!at.node.IsMap()) refuse(at, "expected a map", "kind, file, columns");
  Keys kinds;
  kinds.reserve(streamSpecs().size());
  for (const TableSpec& spec : streamSpecs()) kinds.push_back(spec.kind);
  const std::string expected = "one of " + text::joined(kinds);
  const Entry kind = need(at, "kind", expected);
  const std::string name = textOf(kind, expected);
  const auto& specs = streamSpecs();
  const auto spec =
      std::find_if(specs.begin(), specs.end(), [&](const TableSpec& s) { return s.kind == name; });
  if (spec == specs.end()) refuse(kind, "unknown kind of stream", expected, text::didYouMean(name, kinds));
  Keys allowed{"kind", "sensor"};
  if (name == "gnss") allowed.emplace_back("fix_codes");
  TableMapping table = readTable(at, *spec, allowed);
  if (const auto sensor = find(at, "sensor")) table.sensor = textOf(*sensor, "the sensor's label");
  if (name == "gnss") readGnssOptions(at, table);
  return table;
}

TableMapping readTruth(const Entry& at) {
  TableMapping table = readTable(at, truthSpec(), {});
  const auto count = std::count_if(table.fields.begin(), table.fields.end(),
                                   [](const FieldSource& f) { return f.field.starts_with('q'); });
  const bool with_yaw = has(table.fields, "yaw");
  if (count != 0 && (count != 4 || with_yaw)) {
    refuse(at, "the truth's attitude is not clear", "yaw, or all of qw qx qy qz, or none of them");
  }
  return table;
}

Eigen::Vector3d readPoint(const Entry& at) {
  return {numberOf(need(at, "x_m", "metres"), "metres"), numberOf(need(at, "y_m", "metres"), "metres"),
          numberOf(need(at, "z_m", "metres"), "metres")};
}

std::vector<map::Anchor> listedAnchors(const Entry& at) {
  std::vector<map::Anchor> anchors;
  for (const Entry& entry : listOf(at)) {
    requireKeys(entry, {"id", "x_m", "y_m", "z_m"});
    map::Anchor anchor;
    anchor.id = idOf(need(entry, "id", "a whole number"));
    anchor.name = std::to_string(anchor.id);
    anchor.p_map = readPoint(entry);
    anchors.push_back(anchor);
  }
  return anchors;
}

std::vector<std::pair<TagId, Eigen::Vector3d>> listedTags(const Entry& at) {
  std::vector<std::pair<TagId, Eigen::Vector3d>> tags;
  for (const Entry& entry : listOf(at)) {
    requireKeys(entry, {"id", "x_m", "y_m", "z_m"});
    tags.emplace_back(idOf(need(entry, "id", "a whole number")), readPoint(entry));
  }
  return tags;
}

/// Anchors and tags are a map (a table) or a list (written out); nothing when the form is the other one.
std::optional<Entry> findTable(const Entry& root, const std::string& key) {
  const auto entry = find(root, key);
  return entry && !entry->node.IsSequence() ? entry : std::nullopt;
}
std::optional<Entry> findList(const Entry& root, const std::string& key) {
  const auto entry = find(root, key);
  return entry && entry->node.IsSequence() ? entry : std::nullopt;
}

ImportMapping readMapping(const Entry& root) {
  requireKeys(root, {"name", "origin_s", "streams", "truth", "anchors", "tags"});
  ImportMapping mapping;
  mapping.name = textOf(need(root, "name", "the name of the data set"), "the name of the data set");
  if (const auto origin = find(root, "origin_s")) {
    mapping.origin = Stamp{secondsOf(*origin, std::chrono::seconds(4'500'000'000),
                                     "calendar time of the tables' t = 0, seconds since 1970-01-01")};
  }
  const Entry streams = need(root, "streams", "a list of streams");
  for (const Entry& entry : listOf(streams)) mapping.streams.push_back(readStream(entry));
  if (mapping.streams.empty()) refuse(streams, "there are no streams", "at least one");
  if (const auto truth = find(root, "truth")) mapping.truth = readTruth(*truth);
  if (const auto table = findTable(root, "anchors")) mapping.anchors = readTable(*table, anchorsSpec(), {});
  if (const auto list = findList(root, "anchors")) mapping.listed_anchors = listedAnchors(*list);
  if (const auto table = findTable(root, "tags")) mapping.tags = readTable(*table, tagsSpec(), {});
  if (const auto list = findList(root, "tags")) mapping.listed_tags = listedTags(*list);
  return mapping;
}

}  // namespace

ImportMapping parseImportMapping(const std::string& text, const std::string& file) {
  try {
    return readMapping(Entry{YAML::Load(text), "", file});
  } catch (const YAML::Exception& error) {
    throw ConfigError(Complaint{.what = "not good YAML: " + error.msg, .place = placeOf(error.mark, file)});
  }
}

ImportMapping readImportMapping(const std::filesystem::path& path) {
  const std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw ConfigError(Complaint{.what = "cannot open the mapping file",
                                .place = {.file = path.string()},
                                .suggestion = "check the path; configs/import holds examples"});
  }
  std::ostringstream text;
  text << file.rdbuf();
  return parseImportMapping(text.str(), path.string());
}

}  // namespace pos::io
