#include <array>
#include <cstdio>
#include <ctime>

#include "pos/io/log_info.hpp"

namespace pos::io {
namespace {

constexpr std::size_t kMostLines = 12;

template <typename... Arguments>
std::string formatted(const char* pattern, Arguments... arguments) {
  std::array<char, 320> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), pattern, arguments...);
  return {buffer.data(), std::min(static_cast<std::size_t>(std::max(0, length)), buffer.size() - 1)};
}

/// Labels come from the file: keep control characters off the terminal.
std::string shown(const std::string& text, std::size_t limit = 28) {
  std::string result = text.substr(0, limit);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  }
  return result;
}

std::string dateOf(Stamp stamp) {
  const auto ns = stamp.time_since_epoch().count();
  const std::time_t whole = static_cast<std::time_t>(ns / 1'000'000'000 - (ns % 1'000'000'000 < 0 ? 1 : 0));
  std::tm parts{};
  gmtime_r(&whole, &parts);
  return formatted("%04d-%02d-%02d %02d:%02d:%02d UTC", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday,
                   parts.tm_hour, parts.tm_min, parts.tm_sec);
}

const char* nameOf(LogFormat format) {
  switch (format) {
    case LogFormat::Observations:
      return "observations only";
    case LogFormat::ActionsAndFrames:
      return "actions and sensory frames";
    case LogFormat::Mixed:
      return "frames and free observations mixed";
    case LogFormat::Mcap:
      return "messages of ROS 2 (MCAP)";
    case LogFormat::PackedCopy:
      return "packed copy of a log";
    case LogFormat::Unknown:
      break;
  }
  return "no observations";
}

std::string more(std::size_t total) {
  return total > kMostLines ? formatted("  ... and %zu more\n", total - kMostLines) : "";
}

std::string sensorTable(const LogInfo& info) {
  if (info.sensors.empty()) return "no measurements\n";
  std::string text =
      formatted("%-28s %-12s %9s %9s %12s\n", "sensor", "kind", "count", "rate Hz", "max gap s");
  for (std::size_t i = 0; i < std::min(kMostLines, info.sensors.size()); ++i) {
    const SensorInfo& sensor = info.sensors[i];
    text +=
        formatted("%-28s %-12s %9llu %9.2f %12.3f", shown(sensor.label).c_str(), sensor.kind.c_str(),
                  static_cast<unsigned long long>(sensor.count), sensor.rate, seconds(sensor.largest_gap));
    if (sensor.backwards > 0)
      text += formatted("  %llu back in time", static_cast<unsigned long long>(sensor.backwards));
    text += '\n';
  }
  return text + more(info.sensors.size());
}

std::string anchorTable(const LogInfo& info) {
  if (info.anchors.empty()) return "";
  std::string text = formatted("%-28s %22s %9s %9s %9s\n", "anchor", "count", "min m", "median m", "max m");
  for (std::size_t i = 0; i < std::min(kMostLines, info.anchors.size()); ++i) {
    const AnchorInfo& anchor = info.anchors[i];
    text += formatted("%-28d %22llu %9.2f %9.2f %9.2f\n", anchor.id,
                      static_cast<unsigned long long>(anchor.count), anchor.range_min, anchor.range_median,
                      anchor.range_max);
  }
  return text + more(info.anchors.size());
}

std::string counts(const char* title, const std::map<std::string, std::uint64_t>& counted) {
  std::string text;
  for (const auto& [name, count] : counted) {
    text +=
        formatted("%-9s %9llu  %s\n", title, static_cast<unsigned long long>(count), shown(name, 80).c_str());
  }
  return text;
}

}  // namespace

std::string toText(const LogInfo& info) {
  std::string text = shown(info.path, 200) + "\n";
  text += formatted("format    %s, %llu objects, %llu measurements", nameOf(info.format),
                    static_cast<unsigned long long>(info.end.objects),
                    static_cast<unsigned long long>(info.measurements));
  if (info.pairs > 0) text += formatted(", %llu pairs", static_cast<unsigned long long>(info.pairs));
  text += '\n';
  if (info.measurements > 0) {
    text += "from      " + dateOf(info.first) + "\nto        " + dateOf(info.last) +
            formatted("  (%.1f s)\n", seconds(info.duration()));
  }
  text += sensorTable(info) + anchorTable(info) + counts("skipped", info.tally.skipped) +
          counts("refused", info.tally.refused);
  if (info.tally.references > 0) {
    text += formatted("%-9s %9llu  absolute odometry used as first reference\n", "reference",
                      static_cast<unsigned long long>(info.tally.references));
  }
  if (info.end.damaged) {
    text += formatted("DAMAGED after %llu whole objects, at byte %llu of the uncompressed stream: ",
                      static_cast<unsigned long long>(info.end.objects),
                      static_cast<unsigned long long>(info.end.byte)) +
            shown(info.end.message, 200) + "\n";
  } else {
    text += "end       clean\n";
  }
  return text;
}

}  // namespace pos::io
