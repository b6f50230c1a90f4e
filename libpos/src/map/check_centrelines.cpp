#include <cmath>

#include "check_parts.hpp"
#include "pos/core/angle.hpp"

namespace pos::map {
namespace {

/// Sum of all turning between two chainages, rad.
double turning(const Centreline& line, double from, double to) {
  double sum = 0.0;
  const auto& segments = line.segments();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const CentrelineSegment& segment = segments[i];
    const double low = std::max(from, segment.chainage);
    const double high = std::min(to, segment.chainage + segment.length);
    if (high > low) sum += segment.curvature * (high - low) * segment.plan_length / segment.length;
    if (i > 0 && segment.chainage >= from && segment.chainage <= to)
      sum += wrapAngle(segment.heading - segments[i - 1].headingAt(segments[i - 1].plan_length));
  }
  return sum;
}

bool isDeclaredBend(const TunnelMap& map, const std::string& roadway, double chainage) {
  for (const Bend& bend : map.bends) {
    if (bend.stretch.roadway == roadway && bend.stretch.from - 1.0 <= chainage &&
        chainage <= bend.stretch.to + 1.0) {
      return true;
    }
  }
  return false;
}

Finding undeclaredBend(const Network& network, RoadwayIndex r, double chainage, double turn) {
  const std::string& id = network.map().roadways[r].id;
  return {.check = Check::UndeclaredBend,
          .severity = Severity::Note,
          .what = "roadway " + id + " turns by " + std::to_string(std::lround(std::abs(degrees(turn)))) +
                  " degrees at chainage " + metres(chainage) + ", but no bend is declared",
          .remedy = "declare a bend there, so that lock intervals know where the straight leg ends",
          .objects = {"roadway " + id},
          .p_map = network.centreline(r).at(chainage).p_map};
}

}  // namespace

Findings nearPoints(const Network& network, const CheckRules& rules) {
  Findings found;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
    const Roadway& roadway = network.map().roadways[r];
    for (std::size_t i = 1; i < roadway.centreline.size(); ++i) {
      const Eigen::Vector3d& p = roadway.centreline[i].p_map;
      const double distance = (p - roadway.centreline[i - 1].p_map).norm();
      if (distance >= rules.coincident) continue;
      found.push_back({.check = Check::NearCoincidentNodes,
                       .severity = Severity::Warning,
                       .what = "points " + std::to_string(i) + " and " + std::to_string(i + 1) +
                               " of roadway " + roadway.id + " are only " + metres(distance) + " apart",
                       .remedy = "remove one of the two; their direction is mostly survey noise",
                       .objects = {"roadway " + roadway.id},
                       .p_map = p});
    }
  }
  return found;
}

Findings stations(const Network& network, const CheckRules& rules) {
  Findings found;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
    const Roadway& roadway = network.map().roadways[r];
    std::optional<double> last;
    for (std::size_t i = 0; i < roadway.centreline.size(); ++i) {
      const CentrelinePoint& point = roadway.centreline[i];
      if (!point.station) continue;
      const auto& segments = network.centreline(r).segments();
      const double computed =
          i < segments.size() ? segments[i].chainage : network.centreline(r).chainageEnd();
      Finding finding{.objects = {"roadway " + roadway.id}, .p_map = point.p_map};
      if (last && *point.station <= *last) {
        finding.check = Check::ReversedChainage;
        finding.what = "the surveyed chainage of roadway " + roadway.id + " falls from " + metres(*last) +
                       " to " + metres(*point.station);
        finding.remedy = "turn the order of the points round, or correct the station";
        found.push_back(finding);
      } else if (std::abs(*point.station - computed) > rules.station_tolerance) {
        finding.check = Check::StationMismatch;
        finding.severity = Severity::Warning;
        finding.what = "roadway " + roadway.id + ": the surveyed chainage is " + metres(*point.station) +
                       ", the length along the centreline gives " + metres(computed);
        finding.remedy = "check chainage_start_m, missing points, and whether slope or plan was measured";
        found.push_back(finding);
      }
      last = point.station;
    }
  }
  return found;
}

Findings grades(const Network& network, const CheckRules& rules) {
  Findings found;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
    const std::string& id = network.map().roadways[r].id;
    for (const CentrelineSegment& segment : network.centreline(r).segments()) {
      if (std::abs(segment.grade) <= rules.steepest_grade) continue;
      found.push_back({.check = Check::SteepGrade,
                       .severity = Severity::Warning,
                       .what = "roadway " + id + " has a slope of " +
                               std::to_string(std::lround(degrees(std::atan(segment.grade)))) +
                               " degrees at chainage " + metres(segment.chainage),
                       .remedy = "look up the heights of the two points",
                       .objects = {"roadway " + id},
                       .p_map = segment.start});
    }
  }
  return found;
}

Findings bends(const Network& network, const CheckRules& rules) {
  Findings found;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
    const auto& segments = network.centreline(r).segments();
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const CentrelineSegment& segment = segments[i];
      const double arc = segment.curvature * segment.plan_length;
      const double kink =
          i == 0 ? 0.0 : wrapAngle(segment.heading - segments[i - 1].headingAt(segments[i - 1].plan_length));
      const double middle = segment.chainage + 0.5 * segment.length;
      const std::string& id = network.map().roadways[r].id;
      if (std::abs(arc) > rules.bend_angle && !isDeclaredBend(network.map(), id, middle))
        found.push_back(undeclaredBend(network, r, middle, arc));
      if (std::abs(kink) > rules.bend_angle && !isDeclaredBend(network.map(), id, segment.chainage))
        found.push_back(undeclaredBend(network, r, segment.chainage, kink));
    }
  }
  for (const Bend& bend : network.map().bends) {
    const Centreline& line = network.centreline(network.indexOf(bend.stretch.roadway));
    const double turn = turning(line, bend.stretch.from - 1e-6, bend.stretch.to + 1e-6);
    if (std::abs(turn) > 0.5 * rules.bend_angle) continue;
    found.push_back({.check = Check::BendNotThere,
                     .severity = Severity::Warning,
                     .what = "bend " + bend.id + " is declared where roadway " + bend.stretch.roadway +
                             " turns by only " + std::to_string(std::lround(std::abs(degrees(turn)))) +
                             " degrees",
                     .remedy = "correct from_m and to_m of the bend, or remove it",
                     .objects = {"bend " + bend.id, "roadway " + bend.stretch.roadway},
                     .p_map = line.at(0.5 * (bend.stretch.from + bend.stretch.to)).p_map});
  }
  return found;
}

Findings clearances(const Network& network, const CheckRules& rules) {
  Findings found;
  if (!network.map().requirements) return found;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
    const Roadway& roadway = network.map().roadways[r];
    for (const SiteVehicle& vehicle : network.map().requirements->vehicles) {
      const ClearanceReport report = clearance(roadway, {vehicle.width, vehicle.height}, rules.clearance);
      for (const ClearanceRow& row : report.violations()) {
        const Centreline& line = network.centreline(r);
        found.push_back({.check = row.rule.starts_with("width") ? Check::TooNarrow : Check::TooLow,
                         .severity = Severity::Error,
                         .what = "roadway " + roadway.id + " has " + metres(row.found) + " of " + row.rule +
                                 ", vehicle " + vehicle.id + " needs " + metres(row.needed),
                         .remedy = "widen the roadway, forbid it to this vehicle, or correct its size",
                         .objects = {"roadway " + roadway.id, "vehicle " + vehicle.id},
                         .p_map = line.at(line.chainageStart() + 0.5 * line.length()).p_map});
      }
    }
  }
  return found;
}

}  // namespace pos::map
