#pragma once
/// What is in a log, gathered in one pass.

#include <map>
#include <string>
#include <vector>

#include "pos/io/log_reader.hpp"

namespace pos::io {

struct SensorInfo {
  std::string label;
  std::string kind;  ///< the reading's name
  std::uint64_t count = 0;
  Stamp first;
  Stamp last;
  double rate = 0.0;            ///< Hz between first and last, 0 for a single moment
  Duration largest_gap{};       ///< between readings next to each other in the file
  std::uint64_t backwards = 0;  ///< readings older than the one before them
};

struct AnchorInfo {
  AnchorId id = 0;
  std::uint64_t count = 0;
  double range_min = 0.0;     ///< m
  double range_median = 0.0;  ///< m, to a centimetre
  double range_max = 0.0;     ///< m
};

struct LogInfo {
  std::string path;
  LogFormat format = LogFormat::Unknown;
  std::uint64_t measurements = 0;
  Stamp first;  ///< earliest and latest stamp; both zero without measurements
  Stamp last;
  std::vector<SensorInfo> sensors;  ///< by label, then kind
  std::vector<AnchorInfo> anchors;  ///< by id
  std::uint64_t pairs = 0;          ///< action/observation pairs with a measurement
  LogTally tally;
  LogEnd end;

  Duration duration() const { return last - first; }
};

/// Reads the log once; memory grows with sensors and anchors, not with length. Throws as openLogItself does.
LogInfo logInfo(const std::string& path);

/// One screen for people.
std::string toText(const LogInfo& info);

}  // namespace pos::io
