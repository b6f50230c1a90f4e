#include "pos/io/interval_options.hpp"

#include <algorithm>

#include "pos/core/error.hpp"

namespace pos::io {
namespace {

const IntervalAid* find(const std::vector<IntervalAid>& all, const std::string& estimator) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const IntervalAid& a) { return a.estimator == estimator; });
  return found != all.end() ? &*found : nullptr;
}

std::vector<NamedValue<PassageUse>> passageNames() {
  return {{"as_told", PassageUse::AsTold}, {"none", PassageUse::None}, {"checked", PassageUse::Checked}};
}

OptionTable<IntervalAid> aidOptions() {
  return OptionTable<IntervalAid>("estimators", "What the map gives back to one estimator.")
      .text("estimator", &IntervalAid::estimator, "Name of the estimator.")
      .required()
      .flag("aiding", &IntervalAid::aiding, "As intervals.aiding, for this one.")
      .choice("passages", &IntervalAid::passages, passageNames(), "As intervals.passages, for this one.");
}

}  // namespace

map::DivisionRules IntervalsConfig::division() const {
  map::DivisionRules rules;
  rules.merge = merge;
  rules.straight_within = straight_within;
  return rules;
}

interval::MatchRules IntervalsConfig::match() const {
  interval::MatchRules rules;
  rules.heading_sigma = heading_sigma;
  rules.commit = commit;
  rules.look_ahead = look_ahead;
  rules.lost_after = lost_after;
  return rules;
}

interval::IntervalRules IntervalsConfig::rules() const {
  interval::IntervalRules rules;
  rules.certain = certain;
  rules.listed = listed;
  return rules;
}

interval::RoadAidRules IntervalsConfig::aid() const {
  interval::RoadAidRules rules;
  rules.rate = aiding_rate;
  return rules;
}

bool IntervalsConfig::aids(const std::string& estimator) const {
  const IntervalAid* own = find(estimators, estimator);
  return own != nullptr ? own->aiding.value_or(aiding) : aiding;
}

PassageUse IntervalsConfig::passagesOf(const std::string& estimator) const {
  const IntervalAid* own = find(estimators, estimator);
  return own != nullptr ? own->passages.value_or(passages) : passages;
}

OptionTable<IntervalsConfig> intervalsOptions() {
  using Config = IntervalsConfig;
  return OptionTable<Config>("intervals", "In which lock interval of the map's roadways the vehicle is.")
      .integer("merge", &Config::merge, between(1, 1000), "Every so many chambers are a boundary.")
      .number("straight_within_deg", &Config::straight_within, between(0, 90),
              "A change of heading at a junction that still counts as going on.")
      .number("heading_sigma_deg", &Config::heading_sigma, between(0.1, 90),
              "Spread between the headings of a driving vehicle and its roadway.")
      .number("commit_probability", &Config::commit, between(0.5, 0.999999),
              "Probability at which a branch counts as decided.")
      .number("look_ahead_m", &Config::look_ahead, between(1, 1000),
              "Branches nearer than this are considered before they are reached.")
      .number("lost_after_s", &Config::lost_after, between(0.1, 3600),
              "Time outside every roadway considered before the match starts over.")
      .number("certain_probability", &Config::certain, between(0.5, 0.999999),
              "Probability from which an entry counts; an exit counts below what is left to one.")
      .number("listed_probability", &Config::listed, between(0, 0.5),
              "Intervals less probable than this are not listed.")
      .flag("aiding", &Config::aiding,
            "Whether fixes across the roadway and of its heading go back to the estimators that take them, "
            "once the roadway is decided.")
      .number("aiding_rate_hz", &Config::aiding_rate, between(0.001, 1), "Such fixes per second at most.")
      .choice(
          "passages", &Config::passages, passageNames(),
          "Whether chamber passages of the log go to the estimators as told, not at all, or checked first "
          "against the roadways the vehicle may be on.")
      .list("estimators", &Config::estimators, aidOptions(),
            "What differs for single estimators, to compare them with and without.");
}

}  // namespace pos::io
