#include "pos/io/json_lines.hpp"

#include "json_document.hpp"
#include "json_line_readings.hpp"
#include "pos/core/error.hpp"
#include "pos/io/text.hpp"

namespace pos::io {
namespace {

using namespace json_lines;

constexpr std::string_view kStampKey = "stamp_s";

/// The stamp exactly as written: a double would round it.
Stamp takenStamp(YamlNode& root, const FilePlace& place) {
  for (std::size_t i = 0; i < root.keys.size(); ++i) {
    if (root.keys[i].name != kStampKey) continue;
    const YamlNode value = root.items[i];
    root.keys.erase(root.keys.begin() + static_cast<std::ptrdiff_t>(i));
    root.items.erase(root.items.begin() + static_cast<std::ptrdiff_t>(i));
    const bool bare = value.kind == YamlNode::Kind::Scalar && !value.quoted;
    if (const auto since = bare ? text::duration(value.text) : std::nullopt) return Stamp{*since};
    throw DataError(Complaint{.what = "the stamp is not a time",
                              .place = value.place,
                              .key = std::string(kStampKey),
                              .got = describe(value),
                              .expected = "seconds within +-4.6e9"});
  }
  throw DataError(Complaint{.what = "the line has no stamp",
                            .place = place,
                            .key = std::string(kStampKey),
                            .expected = "seconds since 1970 or the sensors' own origin"});
}

Measurement readLine(std::string_view line, const std::string& name) {
  YamlDocument document = parseJson(std::string(line), name);
  if (document.root.kind != YamlNode::Kind::Table) {
    throw DataError(Complaint{
        .what = "the line is no JSON object", .place = document.root.place, .expected = "{\"stamp_s\": ..."});
  }
  const Stamp stamp = takenStamp(document.root, document.root.place);
  static const OptionTable<Line> kTable = lineOptions();
  return measurementOf(stamp, readOptions(document, kTable));
}

/// The same complaint about the right line.
DataError onLine(Complaint complaint, const std::string& name, int number) {
  complaint.place.file = name;
  complaint.place.line = number;
  return DataError(complaint);
}

}  // namespace

Measurement measurementFrom(std::string_view line, const std::string& name, int line_number) {
  try {
    Measurement measurement = readLine(line, name);
    if (const auto reason = defect(measurement)) {
      throw DataError(Complaint{.what = *reason, .key = measurement.sensor});
    }
    return measurement;
  } catch (const Error& error) {
    throw onLine(error.complaint(), name, line_number);
  }
}

std::string sensorNamedBy(std::string_view line) {
  try {
    const YamlDocument document = parseJson(std::string(line), "line");
    const YamlNode* sensor = document.root.find("sensor");
    return sensor != nullptr && sensor->quoted ? sensor->text : std::string{};
  } catch (const Error&) {
    return {};  // the line says nothing at all
  }
}

std::string jsonLine(const Measurement& measurement) {
  static const OptionTable<Line> kTable = lineOptions();
  const Line line = lineOf(measurement);
  YamlNode root = tableNode();
  root.add(std::string(kStampKey), plainNode(text::stampSeconds(measurement.stamp)));
  const YamlNode rest = writeTable(*kTable.core(), &line, Comments::None);
  for (std::size_t i = 0; i < rest.items.size(); ++i) root.add(rest.keys[i].name, rest.items[i]);
  return compactJson(root);
}

void LineCutter::grow(std::string_view bytes) {
  if (too_long_ || text_.size() + bytes.size() > kLongest) {
    too_long_ = true;
    text_.clear();
  } else {
    text_ += bytes;
  }
}

void LineCutter::give(const Taker& taker) {
  if (text_.ends_with('\r')) text_.pop_back();
  if (too_long_ || !text::trimmed(text_).empty()) taker({number_, text_, too_long_});
  text_.clear();
  too_long_ = false;
  ++number_;
}

void LineCutter::feed(std::string_view bytes, const Taker& taker) {
  for (std::size_t end = bytes.find('\n'); end != std::string_view::npos; end = bytes.find('\n')) {
    grow(bytes.substr(0, end));
    give(taker);
    bytes.remove_prefix(end + 1);
  }
  grow(bytes);
}

void LineCutter::finish(const Taker& taker) {
  if (too_long_ || !text_.empty()) give(taker);
}

}  // namespace pos::io
