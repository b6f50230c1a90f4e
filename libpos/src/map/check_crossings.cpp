#include <algorithm>
#include <cmath>

#include "box_tree.hpp"
#include "check_parts.hpp"

namespace pos::map {
namespace {

/// A short straight piece of a centreline.
struct Chord {
  RoadwayIndex roadway = 0;
  double chainage = 0.0;
  double length = 0.0;  ///< m of chainage
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
};

std::vector<Chord> chords(const Network& network) {
  std::vector<Chord> all;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
    const Centreline& line = network.centreline(r);
    for (const CentrelineSegment& segment : line.segments()) {
      const int count = segment.curvature == 0.0 ? 1 : static_cast<int>(std::ceil(segment.length));
      for (int i = 0; i < count; ++i) {
        const double step = segment.length / count;
        const double chainage = segment.chainage + step * i;
        all.push_back({r, chainage, step, line.at(chainage).p_map, line.at(chainage + step).p_map});
      }
    }
  }
  return all;
}

/// Where two roadways cross in plan.
struct PlanCrossing {
  RoadwayIndex upper = 0;
  RoadwayIndex lower = 0;
  double upper_chainage = 0.0;
  double lower_chainage = 0.0;
  double floors_apart = 0.0;  ///< m
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
};

std::optional<PlanCrossing> crossingOf(const Chord& a, const Chord& b) {
  const Eigen::Vector2d u = (a.to - a.from).head<2>();
  const Eigen::Vector2d v = (b.to - b.from).head<2>();
  const Eigen::Vector2d w = (b.from - a.from).head<2>();
  const double det = u.x() * v.y() - u.y() * v.x();
  if (std::abs(det) < 1e-9 * u.norm() * v.norm()) return std::nullopt;
  const double s = (w.x() * v.y() - w.y() * v.x()) / det;
  const double t = (w.x() * u.y() - w.y() * u.x()) / det;
  if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) return std::nullopt;
  const Eigen::Vector3d p_a = a.from + s * (a.to - a.from);
  const Eigen::Vector3d p_b = b.from + t * (b.to - b.from);
  const PlanCrossing crossing{
      a.roadway, b.roadway, a.chainage + s * a.length, b.chainage + t * b.length, p_a.z() - p_b.z(), p_b};
  if (p_a.z() >= p_b.z()) return crossing;
  return PlanCrossing{crossing.lower,          crossing.upper,    crossing.lower_chainage,
                      crossing.upper_chainage, p_b.z() - p_a.z(), p_a};
}

/// All crossings, one where several chords meet in one point. A roadway may cross itself.
std::vector<PlanCrossing> planCrossings(const Network& network) {
  const std::vector<Chord> all = chords(network);
  std::vector<Box> flat;
  for (const Chord& chord : all) {
    Box box(chord.from.cwiseMin(chord.to), chord.from.cwiseMax(chord.to));
    box.min().z() = box.max().z() = 0.0;
    flat.push_back(box);
  }
  const BoxTree tree(flat);
  std::vector<PlanCrossing> found;
  for (std::size_t i = 0; i < all.size(); ++i) {
    tree.touching(flat[i], [&](std::uint32_t j) {
      const bool neighbours =
          all[i].roadway == all[j].roadway &&
          std::abs(all[i].chainage - all[j].chainage) < 2.0 * (all[i].length + all[j].length);
      if (j <= i || neighbours) return;
      const auto crossing = crossingOf(all[i], all[j]);
      if (!crossing) return;
      const bool again = std::any_of(found.begin(), found.end(), [&](const PlanCrossing& other) {
        return (other.p_map - crossing->p_map).norm() < 0.01;
      });
      if (!again) found.push_back(*crossing);
    });
  }
  return found;
}

bool isAt(const RoadwayPlace& place, const std::string& roadway, double chainage, double reach) {
  return place.roadway == roadway && std::abs(place.chainage - chainage) <= reach;
}

/// Names and widths of the two roadways of a crossing.
struct Pair {
  const Roadway& upper;
  const Roadway& lower;
  double reach() const { return upper.width + lower.width; }
};

bool isJunction(const TunnelMap& map, const PlanCrossing& crossing, const Pair& pair) {
  const auto joins = [&](const Junction& junction, const std::string& roadway, double chainage) {
    return std::any_of(junction.places.begin(), junction.places.end(), [&](const RoadwayPlace& place) {
      return isAt(place, roadway, chainage, pair.reach());
    });
  };
  return std::any_of(map.junctions.begin(), map.junctions.end(), [&](const Junction& junction) {
    return joins(junction, pair.upper.id, crossing.upper_chainage) &&
           joins(junction, pair.lower.id, crossing.lower_chainage);
  });
}

bool fits(const Crossing& declared, const PlanCrossing& crossing, const Pair& pair) {
  return isAt(declared.upper, pair.upper.id, crossing.upper_chainage, pair.reach()) &&
         isAt(declared.lower, pair.lower.id, crossing.lower_chainage, pair.reach());
}

Finding base(const PlanCrossing& crossing, const Pair& pair) {
  return {.objects = {"roadway " + pair.upper.id, "roadway " + pair.lower.id}, .p_map = crossing.p_map};
}

Findings judged(const Network& network, const PlanCrossing& crossing, const CheckRules& rules) {
  const TunnelMap& map = network.map();
  const Pair pair{map.roadways[crossing.upper], map.roadways[crossing.lower]};
  if (isJunction(map, crossing, pair)) return {};
  Findings found;
  const std::string both = "roadway " + pair.upper.id + " (chainage " + metres(crossing.upper_chainage) +
                           ") crosses " + pair.lower.id + " (chainage " + metres(crossing.lower_chainage) +
                           ")";
  const bool declared = std::any_of(map.crossings.begin(), map.crossings.end(),
                                    [&](const Crossing& c) { return fits(c, crossing, pair); });
  const double rock = crossing.floors_apart - pair.lower.height;
  if (!declared) {
    Finding finding = base(crossing, pair);
    finding.check = Check::UndeclaredCrossing;
    finding.severity = rock < 0.0 ? Severity::Error : Severity::Warning;
    finding.what = both + (rock < 0.0 ? " on the same level, but no junction joins them"
                                      : ", " + metres(crossing.floors_apart) +
                                            " above it, and the crossing is not declared");
    finding.remedy = rock < 0.0 ? "add a junction, or correct the heights" : "declare it under crossings";
    found.push_back(finding);
  }
  if (rock < rules.rock_between && (declared || rock >= 0.0)) {
    Finding finding = base(crossing, pair);
    finding.check = Check::CrossingClearance;
    finding.severity = rock < 0.0 ? Severity::Error : Severity::Warning;
    finding.what = both + " with " + metres(rock) + " of rock between roof and floor";
    finding.remedy = "check heights; at least " + metres(rules.rock_between) + " are expected";
    found.push_back(finding);
  }
  return found;
}

}  // namespace

Findings crossings(const Network& network, const CheckRules& rules) {
  const std::vector<PlanCrossing> all = planCrossings(network);
  Findings found;
  for (const PlanCrossing& crossing : all) {
    const Findings here = judged(network, crossing, rules);
    found.insert(found.end(), here.begin(), here.end());
  }
  for (const Crossing& declared : network.map().crossings) {
    const bool there = std::any_of(all.begin(), all.end(), [&](const PlanCrossing& crossing) {
      const auto& roadways = network.map().roadways;
      return fits(declared, crossing, {roadways[crossing.upper], roadways[crossing.lower]});
    });
    if (there) continue;
    const Centreline& line = network.centreline(network.indexOf(declared.upper.roadway));
    found.push_back({.check = Check::CrossingNotThere,
                     .severity = Severity::Warning,
                     .what = "crossing " + declared.id + " says that " + declared.upper.roadway +
                             " passes above " + declared.lower.roadway + ", which it does not do there",
                     .remedy = "correct the chainages, exchange upper and lower, or remove it",
                     .objects = {"crossing " + declared.id},
                     .p_map = line.at(declared.upper.chainage).p_map});
  }
  return found;
}

}  // namespace pos::map
