#include "place_words.hpp"

#include <algorithm>

#include "json_parts.hpp"
#include "pos/io/text.hpp"
#include "pos/serve/state.hpp"

namespace pos::serve {
namespace {

constexpr double kHeld = 0.9;

}  // namespace

using interval::IntervalBelief;
using interval::MatchState;

bool knowsPlace(const IntervalBelief& belief) {
  return belief.state == MatchState::Decided || belief.state == MatchState::Branching;
}

double probabilityOf(const IntervalBelief& belief, std::size_t interval) {
  const auto found = std::find_if(belief.intervals.begin(), belief.intervals.end(),
                                  [&](const auto& listed) { return listed.interval == interval; });
  return found != belief.intervals.end() ? found->probability : 0.0;
}

std::string_view name(Mode mode) {
  switch (mode) {
    case Mode::Run:
      return "run";
    case Mode::Replay:
      return "replay";
    case Mode::Live:
      return "live";
    case Mode::Map:
      return "map";
  }
  return "";
}

Diagnostics modesOf(const Diagnostics& diagnostics) {
  constexpr std::string_view kPrefix = "probability_";
  Diagnostics modes;
  for (const NamedValue& value : diagnostics) {
    if (value.name.starts_with(kPrefix))
      modes.push_back({value.name.substr(kPrefix.size()), value.value, value.sigma});
  }
  return modes;
}

Occupancy occupancy(const IntervalBelief& belief, std::size_t interval) {
  if (!knowsPlace(belief)) return Occupancy::Unknown;
  const double probability = probabilityOf(belief, interval);
  if (probability >= kHeld) return Occupancy::Held;
  return probability > 0.0 ? Occupancy::Doubtful : Occupancy::Free;
}

Occupancy lockState(const IntervalBelief& belief, std::size_t interval, const std::vector<Occupancy>& locks) {
  return interval < locks.size() ? locks[interval] : occupancy(belief, interval);
}

std::string_view name(Occupancy occupancy) {
  switch (occupancy) {
    case Occupancy::Unknown:
      return "unknown";
    case Occupancy::Free:
      return "free";
    case Occupancy::Doubtful:
      return "doubtful";
    case Occupancy::Held:
      return "held";
  }
  return "";
}

std::string words(const IntervalBelief& belief, const Names& names, const std::vector<Occupancy>& locks) {
  if (belief.state == MatchState::Waiting) return "no roadway yet";
  if (belief.state == MatchState::Lost) return "off the roadways";
  std::string text =
      names.roadways[belief.point.roadway] + ", " + io::text::fixed(belief.point.chainage, 1) + " m";
  if (belief.intervals.empty()) return text;
  const std::size_t best = belief.intervals.front().interval;
  return text + ", interval " + names.intervals[best].label() + ", lock " +
         std::string(name(lockState(belief, best, locks)));
}

std::string intervalsJson(const Names& names) {
  Json list = Json::array();
  for (const map::LockInterval& interval : names.intervals) {
    Json spans = Json::array();
    for (const map::IntervalSpan& span : interval.spans) {
      spans.push_back({{"roadway", names.roadways[span.roadway]},
                       {"from_m", number(span.from)},
                       {"to_m", number(span.to)},
                       {"lane", span.lane == map::Lane::Both      ? "both"
                                : span.lane == map::Lane::Forward ? "forward"
                                                                  : "backward"}});
    }
    list.push_back({{"id", interval.id},
                    {"label", interval.label()},
                    {"from", interval.from},
                    {"to", interval.to},
                    {"length_m", number(interval.length())},
                    {"spans", spans},
                    {"inner_chambers", interval.inner_chambers},
                    {"nodes", interval.nodes}});
  }
  return textOf({{"intervals", list}});
}

}  // namespace pos::serve
