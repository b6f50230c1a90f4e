#include "pos/serve/connections.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::serve {
namespace {

constexpr std::size_t kIntervals = 5;
constexpr std::size_t kSeconds = 10;
constexpr double kSameMoment = 1e-3;  // s, ranges of one epoch come together

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::int64_t secondOf(Duration now) {
  return std::chrono::floor<std::chrono::seconds>(now).count();
}

}  // namespace

ConnectionRules validated(ConnectionRules rules) {
  requirePositive(rules.stale_after, "stale_after");
  require(std::isfinite(rules.lost_after) && rules.lost_after >= rules.stale_after, "lost_after",
          "at least stale_after");
  return rules;
}

std::string_view name(Connection connection) {
  switch (connection) {
    case Connection::Waiting:
      return "waiting";
    case Connection::Connected:
      return "connected";
    case Connection::Stale:
      return "stale";
    case Connection::Lost:
      return "lost";
    case Connection::Invalid:
      return "invalid";
    case Connection::Event:
      return "event";
  }
  return "";
}

ConnectionMonitor::ConnectionMonitor(const ConnectionRules& rules, std::vector<AnchorId> anchors)
    : rules_(validated(rules)), order_(std::move(anchors)) {
  for (const AnchorId id : order_) anchors_[id];
}

void ConnectionMonitor::hear(Watched& watched, Duration now) {
  if (watched.heard) {
    const double interval = seconds(now - *watched.heard);
    if (interval > kSameMoment) watched.intervals.push_back(interval);
    if (watched.intervals.size() > kIntervals) watched.intervals.erase(watched.intervals.begin());
  }
  watched.heard = now;
  watched.last_refused = false;
  ++watched.count;
}

void ConnectionMonitor::judge(Watched& watched, Verdict verdict, Duration now) {
  if (verdict != Verdict::Applied && verdict != Verdict::Gated) return;
  watched.last_tested = verdict;
  if (watched.seconds.empty() || watched.seconds.back().number != secondOf(now))
    watched.seconds.push_back({.number = secondOf(now)});
  if (watched.seconds.size() > kSeconds) watched.seconds.erase(watched.seconds.begin());
  ++watched.seconds.back().tested;
  if (verdict == Verdict::Gated) ++watched.seconds.back().gated;
}

void ConnectionMonitor::arrived(const Measurement& measurement, Duration now) {
  const std::lock_guard lock(mutex_);
  Watched& source = sources_[measurement.sensor];
  source.kind = readingName(measurement.reading);
  hear(source, now);
  if (const auto* range = std::get_if<BeaconRange>(&measurement.reading)) {
    const auto anchor = anchors_.find(range->anchor);
    if (anchor != anchors_.end()) hear(anchor->second, now);
  }
}

void ConnectionMonitor::refused(const std::string& source, const std::string& why, Duration now) {
  const std::lock_guard lock(mutex_);
  const auto found = sources_.find(source);
  if (found == sources_.end()) return;  // a bad line must not invent a source
  found->second.last_refused = true;
  found->second.why = why;
  found->second.heard = now;
  ++found->second.refused;
}

void ConnectionMonitor::judged(const Measurement& measurement, Verdict verdict, Duration now) {
  const std::lock_guard lock(mutex_);
  const auto source = sources_.find(measurement.sensor);
  if (source != sources_.end()) judge(source->second, verdict, now);
  if (const auto* range = std::get_if<BeaconRange>(&measurement.reading)) {
    const auto anchor = anchors_.find(range->anchor);
    if (anchor != anchors_.end()) judge(anchor->second, verdict, now);
  }
}

void ConnectionMonitor::forget() {
  const std::lock_guard lock(mutex_);
  sources_.clear();
  for (auto& [id, watched] : anchors_) watched = {};
}

Connection ConnectionMonitor::stateOf(const Watched& watched, Duration now) const {
  if (!watched.heard) return Connection::Waiting;
  if (watched.kind == "passage") return Connection::Event;
  const double age = seconds(now - *watched.heard);
  const double period = median(watched.intervals).value_or(0.0);
  if (age > std::max(rules_.lost_after, 15.0 * period)) return Connection::Lost;
  if (age > std::max(rules_.stale_after, 3.0 * period)) return Connection::Stale;
  return watched.last_refused ? Connection::Invalid : Connection::Connected;
}

Link ConnectionMonitor::linkOf(const Watched& watched, Duration now) const {
  Link link{.state = stateOf(watched, now),
            .period = median(watched.intervals),
            .count = watched.count,
            .refused = watched.refused,
            .why = watched.last_refused ? watched.why : "",
            .last_tested = watched.last_tested};
  if (watched.heard) link.age = std::max(0.0, seconds(now - *watched.heard));
  std::uint64_t tested = 0;
  std::uint64_t gated = 0;
  for (const Second& second : watched.seconds) {
    if (second.number <= secondOf(now) - static_cast<std::int64_t>(kSeconds)) continue;
    tested += second.tested;
    gated += second.gated;
  }
  if (tested > 0) link.gated_ratio = static_cast<double>(gated) / static_cast<double>(tested);
  return link;
}

Connections ConnectionMonitor::at(Duration now) const {
  const std::lock_guard lock(mutex_);
  Connections result;
  for (const auto& [name, watched] : sources_)
    result.sources.push_back({name, watched.kind, linkOf(watched, now)});
  for (const AnchorId id : order_) result.anchors.push_back({id, linkOf(anchors_.at(id), now)});
  return result;
}

std::vector<ConnectionChange> ConnectionMonitor::changes(Duration now) {
  const std::lock_guard lock(mutex_);
  std::vector<ConnectionChange> result;
  for (auto& [name, watched] : sources_) {
    const Connection state = stateOf(watched, now);
    const bool silent = state == Connection::Stale || state == Connection::Lost;
    const bool was_silent = watched.told == Connection::Stale || watched.told == Connection::Lost;
    if (state != watched.told && (silent || was_silent))
      result.push_back({name, state, seconds(now - *watched.heard)});
    watched.told = state;
  }
  return result;
}

}  // namespace pos::serve
