#include "pos/map/checks.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>

#include "check_parts.hpp"
#include "pos/core/config_checks.hpp"

namespace pos::map {

std::string_view name(Severity severity) {
  switch (severity) {
    case Severity::Error:
      return "error";
    case Severity::Warning:
      return "warning";
    case Severity::Note:
      return "note";
  }
  return "";
}

std::string_view name(Check check) {
  static constexpr std::array<std::string_view, 23> kNames = {"near_coincident_nodes",
                                                              "gap",
                                                              "reversed_chainage",
                                                              "station_mismatch",
                                                              "chainage_outside",
                                                              "anchor_outside",
                                                              "anchor_far_from_wall",
                                                              "anchors_coincide",
                                                              "few_anchors",
                                                              "section_without_chamber",
                                                              "section_without_lights",
                                                              "unreachable_node",
                                                              "no_capacity",
                                                              "chamber_too_short",
                                                              "undeclared_crossing",
                                                              "crossing_clearance",
                                                              "crossing_not_there",
                                                              "steep_grade",
                                                              "undeclared_bend",
                                                              "bend_not_there",
                                                              "route_broken",
                                                              "too_narrow",
                                                              "too_low"};
  return kNames.at(static_cast<std::size_t>(check));
}

std::string metres(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f m", value);
  return text.data();
}

CheckRules validated(CheckRules rules) {
  requireNotNegative(rules.coincident, "coincident_m", "m");
  requireNotNegative(rules.gap, "gap_m", "m");
  requireNotNegative(rules.open_end_reach, "open_end_reach_m", "m");
  requireNotNegative(rules.station_tolerance, "station_tolerance_m", "m");
  requireNotNegative(rules.wall_distance, "wall_distance_m", "m");
  requireNotNegative(rules.anchor_slack, "anchor_slack_m", "m");
  requireNotNegative(rules.section_without_chamber, "section_without_chamber_m", "m");
  requireNotNegative(rules.rock_between, "rock_between_m", "m");
  requireNotNegative(rules.light_reach, "light_reach_m", "m");
  requireNotNegative(rules.steepest_grade, "steepest_grade");
  requireNotNegative(rules.bend_angle, "bend_angle_deg");
  requirePositive(rules.sample_step, "sample_step_m", "m");
  requireValid(rules.clearance, "clearance");
  return rules;
}

std::vector<Finding> findings(const Network& network, const CheckRules& rules) {
  (void)validated(rules);
  const RoadGraph graph(network);
  Findings all;
  for (Findings& part : std::vector<Findings>{
           nearPoints(network, rules), stations(network, rules), chainagesOutside(network),
           nodes(graph, rules), junctionGaps(network, rules), openEnds(network, graph, rules),
           unreachable(graph), crossings(network, rules), grades(network, rules), bends(network, rules),
           routes(network, rules), anchors(network, rules), anchorCounts(network, rules), chambers(network),
           sections(network, graph, rules), clearances(network, rules)}) {
    std::move(part.begin(), part.end(), std::back_inserter(all));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
  return all;
}

}  // namespace pos::map
