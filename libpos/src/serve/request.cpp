#include "pos/serve/request.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "pos/io/text.hpp"

namespace pos::serve {
namespace {

constexpr std::size_t kLongest = 4096;

RequestError badTarget(const std::string& what) {
  return badRequest(Complaint{.what = what, .key = "path"});
}

int digitOf(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string decoded(std::string_view text, char plus) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i] == '+' ? plus : text[i];
    if (c == '%') {
      const int high = i + 2 < text.size() ? digitOf(text[i + 1]) : -1;
      const int low = i + 2 < text.size() ? digitOf(text[i + 2]) : -1;
      if (high < 0 || low < 0) throw badTarget("a % is not followed by two hexadecimal digits");
      c = static_cast<char>(16 * high + low);
      i += 2;
    }
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) throw badTarget("the path holds a control character");
    result += c;
  }
  return result;
}

std::vector<std::string> segmentsOf(std::string_view path) {
  std::vector<std::string> segments;
  if (path == "/") return segments;
  while (!path.empty()) {
    path.remove_prefix(1);
    const std::size_t end = std::min(path.find('/'), path.size());
    std::string segment = decoded(path.substr(0, end), '+');
    const bool climbs = segment.empty() || segment == "." || segment == "..";
    if (climbs || segment.find_first_of("/\\") != std::string::npos)
      throw badTarget("a part of the path is empty, climbs, or holds a slash");
    segments.push_back(std::move(segment));
    path.remove_prefix(end);
  }
  return segments;
}

std::map<std::string, std::string> queryOf(std::string_view text) {
  std::map<std::string, std::string> query;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('&'), text.size());
    const std::string_view part = text.substr(0, end);
    const std::size_t equals = std::min(part.find('='), part.size());
    std::string name = decoded(part.substr(0, equals), ' ');
    std::string value = decoded(part.substr(std::min(equals + 1, part.size())), ' ');
    if (!query.emplace(name, std::move(value)).second)
      throw badRequest(Complaint{.what = "the parameter is given twice", .key = name});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return query;
}

nlohmann::ordered_json toJson(int status, const std::string& code, const Complaint& complaint) {
  const std::string place =
      complaint.place.file.empty() && complaint.place.line == 0 ? std::string{} : toString(complaint.place);
  return {{"error",
           {{"status", status},
            {"code", code},
            {"what", complaint.what},
            {"place", place},
            {"key", complaint.key},
            {"got", complaint.got},
            {"expected", complaint.expected},
            {"suggestion", complaint.suggestion}}}};
}

}  // namespace

RequestError badRequest(const Complaint& complaint) {
  return {400, "bad_request", complaint};
}

RequestError notFound(const std::string& what) {
  return {404, "not_found", Complaint{.what = what}};
}

std::string errorJson(const RequestError& error) {
  return errorJson(error.status(), error.code(), error.complaint());
}

std::string errorJson(int status, const std::string& code, const Complaint& complaint) {
  // What a request brought along need not be UTF-8.
  return toJson(status, code, complaint).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string Target::pathText() const {
  std::string text;
  for (const std::string& segment : path) text += "/" + segment;
  return text.empty() ? "/" : text;
}

Target parsedTarget(std::string_view text) {
  if (text.size() > kLongest) throw badTarget("the path is longer than 4096 bytes");
  if (!text.starts_with('/')) throw badTarget("the path does not begin with a slash");
  const std::size_t question = std::min(text.find('?'), text.size());
  return {segmentsOf(text.substr(0, question)), queryOf(text.substr(std::min(question + 1, text.size())))};
}

void requireOnly(const Target& target, const std::vector<std::string>& known) {
  for (const auto& [name, value] : target.query) {
    if (name == "token" || std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw badRequest(Complaint{.what = "this request has no such parameter",
                               .key = name,
                               .got = value,
                               .expected = known.empty() ? "none" : "one of: " + io::text::joined(known),
                               .suggestion = io::text::didYouMean(name, known)});
  }
}

std::optional<double> numberOf(const Target& target, const std::string& name, double min, double max) {
  const auto found = target.query.find(name);
  if (found == target.query.end()) return std::nullopt;
  const auto value = io::text::number(found->second);
  if (value && *value >= min && *value <= max) return value;
  throw badRequest(
      Complaint{.what = "the parameter is no number, or out of range",
                .key = name,
                .got = found->second,
                .expected = "a number from " + io::text::shortest(min) + " to " + io::text::shortest(max)});
}

std::optional<Stamp> stampOf(const Target& target, const std::string& name) {
  const auto found = target.query.find(name);
  if (found == target.query.end()) return std::nullopt;
  if (const auto since = io::text::duration(found->second)) return Stamp{*since};
  throw badRequest(Complaint{.what = "the parameter is no time",
                             .key = name,
                             .got = found->second,
                             .expected = "seconds within +-4.6e9"});
}

std::optional<std::size_t> countOf(const Target& target, const std::string& name, std::size_t min,
                                   std::size_t max) {
  const auto value = numberOf(target, name, static_cast<double>(min), static_cast<double>(max));
  if (!value) return std::nullopt;
  const auto count = static_cast<std::size_t>(*value);
  if (static_cast<double>(count) == *value) return count;
  throw badRequest(Complaint{.what = "the parameter is no whole number", .key = name});
}

}  // namespace pos::serve
