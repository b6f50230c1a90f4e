#include "map_assembly.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"
#include "pos/io/text.hpp"

namespace pos::io {
namespace {

using map::RoadwayPlace;

constexpr double kLevel = 1.0;  // m of height that still is one level
constexpr std::size_t kMostRoadways = 20'000;
constexpr double kLargestLocal = 1e5;  // m from the map's origin

struct Found {
  std::vector<RoadwayPlace> places;
};

bool samePlace(const RoadwayPlace& a, const RoadwayPlace& b, double reach) {
  return a.roadway == b.roadway && std::abs(a.chainage - b.chainage) <= 2.0 * reach;
}

/// Adds the places to a junction that shares one of them, or makes a new one.
void merge(std::vector<Found>& junctions, const std::vector<RoadwayPlace>& places, double reach) {
  Found merged{places};
  const auto shares = [&](const Found& other) {
    return std::any_of(other.places.begin(), other.places.end(), [&](const RoadwayPlace& a) {
      return std::any_of(merged.places.begin(), merged.places.end(),
                         [&](const RoadwayPlace& b) { return samePlace(a, b, reach); });
    });
  };
  const auto add = [&](Found& to, const Found& from) {
    for (const RoadwayPlace& place : from.places) {
      const bool there = std::any_of(to.places.begin(), to.places.end(), [&](const RoadwayPlace& known) {
        return samePlace(known, place, reach);
      });
      if (!there) to.places.push_back(place);
    }
  };
  for (Found& junction : junctions) {
    if (!shares(junction)) continue;
    add(junction, merged);
    return;
  }
  junctions.push_back(std::move(merged));
}

/// The chainage itself, or the end it is near to.
double snapped(const map::Centreline& line, double chainage, double reach) {
  if (chainage <= line.chainageStart() + reach) return line.chainageStart();
  if (chainage >= line.chainageEnd() - reach) return line.chainageEnd();
  return chainage;
}

}  // namespace

RoadwayLines::RoadwayLines(const std::vector<map::Roadway>& roadways)
    : lines(roadways.begin(), roadways.end()) {
  for (const map::Centreline& line : lines) {
    PlanBox& box = boxes.emplace_back();
    for (const map::CentrelineSegment& segment : line.segments()) {
      const int steps =
          segment.curvature == 0.0 ? 1 : 16;  // an arc leaves the box of its chords by less than
      for (int k = 0; k <= steps; ++k) box.add(segment.planAt(segment.plan_length * k / steps));
      if (segment.curvature == 0.0) continue;
      // the sagitta of one of them, R (1 - cos(half a step)) <= length * step / 8
      const double step = segment.plan_length / steps;
      const double sagitta = 0.125 * step * step * std::abs(segment.curvature);
      box.add(box.low.array() - sagitta);
      box.add(box.high.array() + sagitta);
    }
  }
}

std::string FreshIds::take(const std::string& wanted) {
  std::string id = wanted;
  for (int k = 2; taken_.contains(id); ++k) id = wanted + "_" + std::to_string(k);
  taken_.insert(id);
  return id;
}

std::vector<map::Junction> junctionsFound(const std::vector<map::Roadway>& roadways, double reach) {
  if (roadways.size() > kMostRoadways) {
    throw ConfigError(Complaint{.what = "there are too many roadways to look for junctions",
                                .key = "roadways",
                                .got = std::to_string(roadways.size()),
                                .expected = "at most " + std::to_string(kMostRoadways),
                                .suggestion = "map fewer layers as roadway, or join their lines: --join-m"});
  }
  const RoadwayLines made(roadways);
  const auto& lines = made.lines;
  std::vector<Found> found;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const double end : {lines[i].chainageStart(), lines[i].chainageEnd()}) {
      const Eigen::Vector3d p = lines[i].at(end).p_map;
      std::vector<RoadwayPlace> places{{roadways[i].id, end}};
      for (std::size_t j = 0; j < lines.size(); ++j) {
        if (j == i || made.boxes[j].distance(p.head<2>()) > reach) continue;
        const map::Centreline::Foot foot = lines[j].foot(p);
        if (std::hypot(foot.offset, foot.beyond) > reach || std::abs(foot.height) > kLevel) continue;
        places.push_back({roadways[j].id, snapped(lines[j], foot.chainage, reach)});
      }
      if (places.size() > 1) merge(found, places, reach);
    }
  }
  std::vector<map::Junction> junctions;
  for (Found& each : found) {
    junctions.push_back({.id = "J" + std::to_string(junctions.size() + 1), .places = std::move(each.places)});
  }
  return junctions;
}

void requireLocal(const std::vector<Eigen::Vector3d>& points, const std::string& file) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300);
  for (const Eigen::Vector3d& p : points) low = low.cwiseMin(p);
  for (const Eigen::Vector3d& p : points) {
    if (p.head<2>().cwiseAbs().maxCoeff() <= kLargestLocal) continue;
    const auto rounded = [](double v) { return text::fixed(1000.0 * std::floor(v / 1000.0), 0); };
    throw ConfigError(Complaint{.what = "the coordinates are too large for a map's own frame",
                                .place = {.file = file},
                                .got = text::fixed(p.x(), 3) + ", " + text::fixed(p.y(), 3),
                                .expected = "within 100 km of the map's origin",
                                .suggestion = "if this is the mine's grid, name the origin of the map in it: "
                                              "--grid-origin " +
                                              rounded(low.x()) + "," + rounded(low.y()) + ",0"});
  }
}

std::optional<NearestPlace> nearestRoadway(const RoadwayLines& roadways, const Eigen::Vector3d& p_map,
                                           double reach, double level) {
  std::optional<NearestPlace> nearest;
  double least = reach;
  for (std::size_t i = 0; i < roadways.lines.size(); ++i) {
    if (roadways.boxes[i].distance(p_map.head<2>()) > least) continue;
    const map::Centreline::Foot foot = roadways.lines[i].foot(p_map);
    const double distance = std::hypot(foot.offset, foot.beyond);
    if (distance > least || std::abs(foot.height) > level) continue;
    least = distance;
    nearest = NearestPlace{i, foot.chainage, foot.offset, foot.beyond};
  }
  return nearest;
}

}  // namespace pos::io
