#include "pos/io/log_info.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pos/io/rawlog_reader.hpp"

namespace pos::io {
namespace {

/// Ranges of one anchor, counted by the centimetre.
struct RangeCounts {
  AnchorInfo info;
  std::map<std::int64_t, std::uint64_t> centimetres;

  void add(double range) {
    info.range_min = info.count == 0 ? range : std::min(info.range_min, range);
    info.range_max = std::max(info.range_max, range);
    ++info.count;
    ++centimetres[std::llround(100.0 * std::min(range, 1e6))];
  }

  AnchorInfo summary() const {
    AnchorInfo result = info;
    std::uint64_t below = 0;
    for (const auto& [centimetre, count] : centimetres) {
      below += count;
      if (2 * below < info.count) continue;
      result.range_median =
          std::clamp(0.01 * static_cast<double>(centimetre), info.range_min, info.range_max);
      break;
    }
    return result;
  }
};

void add(SensorInfo& sensor, Stamp previous, Stamp stamp) {
  if (sensor.count++ == 0) {
    sensor.first = stamp;
    sensor.last = stamp;
    return;
  }
  sensor.first = std::min(sensor.first, stamp);
  sensor.last = std::max(sensor.last, stamp);
  sensor.largest_gap = std::max(sensor.largest_gap, stamp - previous);
  if (stamp < previous) ++sensor.backwards;
}

double rateOf(const SensorInfo& sensor) {
  const double span = seconds(sensor.last - sensor.first);
  return span > 0.0 ? static_cast<double>(sensor.count - 1) / span : 0.0;
}

}  // namespace

LogInfo logInfo(const std::string& path) {
  const std::unique_ptr<LogReader> log = openLogItself(path);
  const auto* rawlog = dynamic_cast<const RawlogReader*>(log.get());
  LogInfo info;
  info.path = path;
  std::map<std::pair<std::string, std::size_t>, std::pair<SensorInfo, Stamp>> sensors;
  std::map<AnchorId, RangeCounts> anchors;
  std::optional<std::size_t> last_frame;
  while (const auto measurement = log->next()) {
    const Stamp stamp = measurement->stamp;
    info.first = info.measurements == 0 ? stamp : std::min(info.first, stamp);
    info.last = info.measurements == 0 ? stamp : std::max(info.last, stamp);
    ++info.measurements;
    auto& [sensor, previous] = sensors[{measurement->sensor, measurement->reading.index()}];
    sensor.label = measurement->sensor;
    sensor.kind = readingName(measurement->reading);
    add(sensor, previous, stamp);
    previous = stamp;
    if (const auto* range = std::get_if<BeaconRange>(&measurement->reading)) {
      anchors[range->anchor].info.id = range->anchor;
      anchors[range->anchor].add(range->range);
    }
    if (rawlog == nullptr || rawlog->format() == LogFormat::Observations) continue;
    if (const auto frame = rawlog->frame(); frame && frame != last_frame) {
      last_frame = frame;
      ++info.pairs;
    }
  }
  for (auto& [key, entry] : sensors) {
    entry.first.rate = rateOf(entry.first);
    info.sensors.push_back(std::move(entry.first));
  }
  for (const auto& [id, counts] : anchors) info.anchors.push_back(counts.summary());
  info.format = log->format();
  info.tally = log->tally();
  info.end = log->end();
  return info;
}

}  // namespace pos::io
