#include "pos/map/network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "box_tree.hpp"
#include "pos/core/edit_distance.hpp"
#include "pos/core/error.hpp"
#include "volume.hpp"

namespace pos::map {
namespace {

struct SegmentPlace {
  RoadwayIndex roadway = 0;
  std::size_t segment = 0;
};

double squaredToCentre(const Projection& projection) {
  const TunnelPoint& p = projection.point;
  return p.offset * p.offset + p.height * p.height + projection.beyond * projection.beyond;
}

bool better(const Projection& a, const Projection& b) {
  return a.excess != b.excess ? a.excess < b.excess : squaredToCentre(a) < squaredToCentre(b);
}

Box boxAround(const Eigen::Vector3d& p, double reach) {
  return {p - Eigen::Vector3d::Constant(reach), p + Eigen::Vector3d::Constant(reach)};
}

/// Box around the cross-sections of a whole segment.
Box boxOf(const CentrelineSegment& segment, const Roadway& roadway) {
  const int samples = 2 + static_cast<int>(std::abs(segment.curvature) * segment.plan_length / 0.1);
  Box box;
  for (int i = 0; i <= samples; ++i) {
    const double u = segment.plan_length * i / samples;
    const Eigen::Vector2d plan = segment.planAt(u);
    box.extend(Eigen::Vector3d(plan.x(), plan.y(), segment.start.z() + segment.grade * u));
  }
  // Between two samples an arc leaves its chord by less than step * swept / 8.
  const double bulge = segment.plan_length / samples * 0.1;
  const double side = 0.5 * roadway.width + (segment.curvature == 0.0 ? 0.0 : bulge);
  box.min() -= Eigen::Vector3d(side, side, 0.0);
  box.max() += Eigen::Vector3d(side, side, roadway.height);
  return box;
}

std::string nearestId(const TunnelMap& map, const std::string& wanted) {
  std::string best;
  std::size_t fewest = 4;
  for (const Roadway& roadway : map.roadways) {
    const std::size_t edits = editDistance(wanted, roadway.id);
    if (edits >= fewest) continue;
    fewest = edits;
    best = "did you mean " + roadway.id + "?";
  }
  return best;
}

}  // namespace

struct Network::Content {
  explicit Content(std::shared_ptr<const TunnelMap> tunnel_map);

  Projection projected(const SegmentPlace& place, const Eigen::Vector3d& p_map) const;

  std::shared_ptr<const TunnelMap> map;
  std::vector<Centreline> centrelines;
  std::vector<SegmentPlace> segments;
  std::vector<Volume> volumes;
  std::unordered_map<std::string, RoadwayIndex> index_of;
  std::vector<std::vector<std::size_t>> chambers_on;
  BoxTree segment_tree;
  BoxTree volume_tree;
  BoxTree anchor_tree;

 private:
  void addRoadways();
  void addVolumes();
};

Network::Content::Content(std::shared_ptr<const TunnelMap> tunnel_map) : map(std::move(tunnel_map)) {
  ensure(map != nullptr, "a network needs a map");
  (void)validated(*map);
  addRoadways();
  addVolumes();
  std::vector<Box> boxes;
  for (const Anchor& anchor : map->anchors) boxes.push_back(boxAround(anchor.p_map, 0.0));
  anchor_tree = BoxTree(boxes);
}

void Network::Content::addRoadways() {
  std::vector<Box> boxes;
  for (RoadwayIndex r = 0; r < map->roadways.size(); ++r) {
    index_of.emplace(map->roadways[r].id, r);
    const Centreline& line = centrelines.emplace_back(map->roadways[r]);
    for (std::size_t s = 0; s < line.segments().size(); ++s) {
      segments.push_back({r, s});
      boxes.push_back(boxOf(line.segments()[s], map->roadways[r]));
    }
  }
  segment_tree = BoxTree(boxes);
  chambers_on.resize(map->roadways.size());
  for (std::size_t c = 0; c < map->chambers.size(); ++c)
    chambers_on[index_of.at(map->chambers[c].place.roadway)].push_back(c);
}

void Network::Content::addVolumes() {
  for (RoadwayIndex r = 0; r < map->roadways.size(); ++r) {
    const std::vector<Volume> pieces = slices(map->roadways[r], centrelines[r]);
    volumes.insert(volumes.end(), pieces.begin(), pieces.end());
  }
  for (const Chamber& chamber : map->chambers) {
    if (chamber.length <= 0.0 || chamber.depth <= 0.0) continue;
    const RoadwayIndex r = index_of.at(chamber.place.roadway);
    volumes.push_back(niche(chamber, map->roadways[r], centrelines[r]));
  }
  std::vector<Box> boxes;
  for (const Volume& volume : volumes) boxes.push_back(volume.box());
  volume_tree = BoxTree(boxes);
}

Projection Network::Content::projected(const SegmentPlace& place, const Eigen::Vector3d& p_map) const {
  const Roadway& roadway = map->roadways[place.roadway];
  const Centreline::Foot foot = centrelines[place.roadway].footOnSegment(place.segment, p_map);
  const double across = std::max(0.0, std::abs(foot.offset) - 0.5 * roadway.width);
  const double up = std::max({0.0, -foot.height, foot.height - roadway.height});
  return {.point = {place.roadway, foot.chainage, foot.offset, foot.height},
          .beyond = foot.beyond,
          .excess = std::sqrt(across * across + up * up + foot.beyond * foot.beyond)};
}

Network::Network(std::shared_ptr<const TunnelMap> map)
    : content_(std::make_shared<const Content>(std::move(map))) {}

const TunnelMap& Network::map() const {
  return *content_->map;
}

const Centreline& Network::centreline(RoadwayIndex roadway) const {
  return content_->centrelines.at(roadway);
}

RoadwayIndex Network::indexOf(const std::string& roadway) const {
  const auto found = content_->index_of.find(roadway);
  if (found != content_->index_of.end()) return found->second;
  throw ConfigError(
      Complaint{.what = "there is no such roadway", .got = roadway, .suggestion = nearestId(map(), roadway)});
}

const std::vector<std::size_t>& Network::chambersOn(RoadwayIndex roadway) const {
  return content_->chambers_on.at(roadway);
}

std::optional<Projection> Network::project(const Eigen::Vector3d& p_map) const {
  std::optional<Projection> best;
  content_->segment_tree.nearest(p_map, [&](std::uint32_t i) {
    const Projection projection = content_->projected(content_->segments[i], p_map);
    if (!best || better(projection, *best)) best = projection;
    return best->excess;
  });
  return best;
}

std::vector<Projection> Network::candidates(const Eigen::Vector3d& p_map, double radius) const {
  std::vector<Projection> found;
  content_->segment_tree.touching(boxAround(p_map, radius), [&](std::uint32_t i) {
    const Projection projection = content_->projected(content_->segments[i], p_map);
    if (projection.excess > radius) return;
    const auto same = std::find_if(found.begin(), found.end(), [&](const Projection& p) {
      return p.point.roadway == projection.point.roadway;
    });
    if (same == found.end()) {
      found.push_back(projection);
    } else if (better(projection, *same)) {
      *same = projection;
    }
  });
  std::sort(found.begin(), found.end(), [](const Projection& a, const Projection& b) {
    return better(a, b) || (!better(b, a) && a.point.roadway < b.point.roadway);
  });
  return found;
}

Eigen::Vector3d Network::toMap(const TunnelPoint& point) const {
  const CentrelineState state = centreline(point.roadway).at(point.chainage);
  return state.p_map + Eigen::Vector3d(-std::sin(state.heading) * point.offset,
                                       std::cos(state.heading) * point.offset, point.height);
}

bool Network::isInside(const Eigen::Vector3d& p_map, double slack) const {
  if (content_->volumes.empty()) return true;
  bool inside = false;
  content_->volume_tree.touching(boxAround(p_map, slack), [&](std::uint32_t i) {
    inside = inside || content_->volumes[i].holds(p_map, slack);
  });
  return inside;
}

bool Network::inSight(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double slack) const {
  if (content_->volumes.empty()) return true;
  std::vector<Part> parts;
  content_->volume_tree.along(a, b, slack, [&](std::uint32_t i) {
    if (const auto part = partInside(content_->volumes[i], a, b, slack)) parts.push_back(*part);
  });
  std::sort(parts.begin(), parts.end(), [](const Part& x, const Part& y) { return x.begin < y.begin; });
  double reached = 0.0;
  for (const Part& part : parts) {
    if (part.begin > reached + 1e-9) return false;
    reached = std::max(reached, part.end);
  }
  return !parts.empty() && reached >= 1.0 - 1e-9;
}

std::vector<std::size_t> Network::visibleAnchors(const Eigen::Vector3d& p_map, double range_limit,
                                                 double slack) const {
  std::vector<std::size_t> visible;
  content_->anchor_tree.touching(boxAround(p_map, range_limit), [&](std::uint32_t i) {
    const Eigen::Vector3d& anchor = map().anchors[i].p_map;
    if ((anchor - p_map).norm() <= range_limit && inSight(p_map, anchor, slack)) visible.push_back(i);
  });
  std::sort(visible.begin(), visible.end());
  return visible;
}

double Network::wallDistance(const TunnelPoint& point) const {
  return 0.5 * map().roadways.at(point.roadway).width - std::abs(point.offset);
}

}  // namespace pos::map
