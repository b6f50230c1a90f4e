#include "pos/map/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pos/core/config_checks.hpp"

namespace pos::map {
namespace {

/// Lower of the two roof heights over the vehicle's sides.
double roofOver(const Roadway& roadway, double side_a, double side_b) {
  return std::min(roofHeight(roadway, side_a), roofHeight(roadway, side_b));
}

}  // namespace

ClearanceRules validated(ClearanceRules rules) {
  requireNotNegative(rules.wall_gap, "wall_gap_m", "m");
  requireNotNegative(rules.walkway, "walkway_m", "m");
  requireNotNegative(rules.meeting_gap, "meeting_gap_m", "m");
  requireNotNegative(rules.roof_gap, "roof_gap_m", "m");
  return rules;
}

double neededWidth(int lanes, const VehicleSize& vehicle, const VehicleSize& meeting,
                   const ClearanceRules& rules) {
  const double one = rules.wall_gap + vehicle.width + rules.walkway;
  return lanes == 1 ? one : one + meeting.width + rules.meeting_gap;
}

std::vector<ClearanceRow> ClearanceReport::violations() const {
  std::vector<ClearanceRow> violated;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(violated),
               [](const ClearanceRow& row) { return row.violated(); });
  return violated;
}

ClearanceReport clearance(const Roadway& roadway, const VehicleSize& vehicle, const ClearanceRules& rules) {
  const double wall = 0.5 * roadway.width;
  const double near_side = wall - rules.wall_gap;
  const double far_side = near_side - vehicle.width;
  const double roof = vehicle.height + rules.roof_gap;
  ClearanceReport report;
  report.rows.push_back({.rule = roadway.lanes == 1 ? "width for one vehicle" : "width for two that meet",
                         .needed = neededWidth(roadway.lanes, vehicle, vehicle, rules),
                         .found = roadway.width});
  report.rows.push_back({.rule = "roof over the vehicle by the wall",
                         .needed = roof,
                         .found = roofOver(roadway, near_side, far_side)});
  if (roadway.lanes == 2) {
    const double other_far = far_side - rules.meeting_gap - vehicle.width;
    report.rows.push_back({.rule = "roof over the vehicle by the walkway",
                           .needed = roof,
                           .found = roofOver(roadway, far_side - rules.meeting_gap, other_far)});
  }
  return report;
}

double roofHeight(const Roadway& roadway, double offset) {
  const double radius = 0.5 * roadway.width;
  if (std::abs(offset) > radius) return 0.0;
  if (roadway.section == Section::Rectangle) return roadway.height;
  return roadway.height - radius + std::sqrt(radius * radius - offset * offset);
}

}  // namespace pos::map
