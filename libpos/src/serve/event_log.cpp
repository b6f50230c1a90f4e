#include "pos/serve/event_log.hpp"

#include <algorithm>

#include "json_parts.hpp"

namespace pos::serve {
namespace {

Json toJson(std::uint64_t n, const io::RunEvent& event) {
  return {{"n", n},
          {"stamp_s", secondsSinceOrigin(event.stamp)},
          {"estimator", event.estimator},
          {"kind", event.kind},
          {"sensor", event.sensor},
          {"detail", event.detail}};
}

}  // namespace

std::string eventJson(std::uint64_t n, const io::RunEvent& event) {
  return textOf(toJson(n, event));
}

void EventLog::add(io::RunEvent event) {
  events_.push_back(std::move(event));
  if (events_.size() <= kMost) return;
  events_.pop_front();
  ++first_;
}

void EventLog::clear() {
  events_.clear();
  first_ = 0;
}

std::string EventLog::json(std::uint64_t after, std::size_t limit) const {
  Json list = Json::array();
  const std::uint64_t from = std::clamp(after, first_, total());
  const std::uint64_t to = std::min<std::uint64_t>(total(), from + limit);
  for (std::uint64_t n = from; n < to; ++n) list.push_back(toJson(n, events_[n - first_]));
  return textOf({{"events", list}, {"total", total()}});
}

}  // namespace pos::serve
