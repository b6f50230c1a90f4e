#include "pos/map/centreline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"

namespace pos::map {
namespace {

Eigen::Vector2d unit(double heading) {
  return {std::cos(heading), std::sin(heading)};
}
Eigen::Vector2d left(double heading) {
  return {-std::sin(heading), std::cos(heading)};
}

/// The segment from `from` to the place `to`, swept by from.arc.
CentrelineSegment segmentBetween(const CentrelinePoint& from, const Eigen::Vector3d& to, double chainage) {
  const Eigen::Vector2d chord = (to - from.p_map).head<2>();
  const double c = chord.norm();
  CentrelineSegment segment{.start = from.p_map,
                            .heading = wrapAngle(std::atan2(chord.y(), chord.x()) - 0.5 * from.arc),
                            .curvature = 2.0 * std::sin(0.5 * from.arc) / c,
                            .plan_length = c,
                            .chainage = chainage};
  if (segment.curvature != 0.0) segment.plan_length = from.arc / segment.curvature;
  const double rise = to.z() - from.p_map.z();
  segment.grade = rise / segment.plan_length;
  segment.length = std::hypot(segment.plan_length, rise);
  return segment;
}

/// Plan distance along the segment's own (unbounded) line or circle to the foot of `p`.
double unboundedFoot(const CentrelineSegment& segment, const Eigen::Vector2d& p) {
  const Eigen::Vector2d d = p - segment.start.head<2>();
  if (segment.curvature == 0.0) return d.dot(unit(segment.heading));
  const double radius = 1.0 / segment.curvature;
  const Eigen::Vector2d from_centre = d - radius * left(segment.heading);
  const Eigen::Vector2d start = -radius * left(segment.heading);
  const double swept =
      std::atan2(start.x() * from_centre.y() - start.y() * from_centre.x(), start.dot(from_centre));
  // The foot nearest to the arc's middle: past the far side of the circle the other way round is shorter.
  const double middle = 0.5 * segment.curvature * segment.plan_length;
  return (middle + wrapAngle(swept - middle)) * radius;
}

}  // namespace

Eigen::Vector2d CentrelineSegment::planAt(double u) const {
  const double half = 0.5 * curvature * u;
  const double sinc = std::abs(half) < 1e-6 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  return start.head<2>() + u * sinc * unit(heading + half);
}

Eigen::Vector3d CentrelineSegment::endPoint() const {
  const Eigen::Vector2d plan = planAt(plan_length);
  return {plan.x(), plan.y(), start.z() + grade * plan_length};
}

SegmentFoot footOn(const CentrelineSegment& segment, const Eigen::Vector3d& p_map) {
  const double free = unboundedFoot(segment, p_map.head<2>());
  const double u = std::clamp(free, 0.0, segment.plan_length);
  const Eigen::Vector2d d = p_map.head<2>() - segment.planAt(u);
  const double tangent = segment.headingAt(u);
  const double across = d.dot(left(tangent));
  const double along = d.dot(unit(tangent));
  return {.u = u,
          .beyond = free == u ? 0.0 : std::abs(along),
          .offset = across,
          .height = p_map.z() - (segment.start.z() + segment.grade * u)};
}

Centreline::Centreline(const Roadway& roadway) : start_(roadway.chainage_start), end_(start_) {
  if (roadway.centreline.size() < 2) {
    throw ConfigError(Complaint{.what = "a centreline needs at least two points",
                                .key = "roadway " + roadway.id,
                                .got = std::to_string(roadway.centreline.size())});
  }
  for (std::size_t i = 0; i + 1 < roadway.centreline.size(); ++i) {
    const CentrelineSegment segment =
        segmentBetween(roadway.centreline[i], roadway.centreline[i + 1].p_map, end_);
    if (!std::isfinite(segment.length) || !(segment.plan_length > 0.0)) {
      throw ConfigError(Complaint{.what = "a centreline has two points at the same place in plan",
                                  .key = "roadway " + roadway.id,
                                  .got = "point " + std::to_string(i + 1)});
    }
    segments_.push_back(segment);
    end_ += segment.length;
  }
}

std::size_t Centreline::segmentAt(double chainage) const {
  const auto after = std::upper_bound(segments_.begin() + 1, segments_.end(), chainage,
                                      [](double c, const CentrelineSegment& s) { return c < s.chainage; });
  return static_cast<std::size_t>(after - segments_.begin()) - 1;
}

CentrelineState Centreline::at(double chainage) const {
  const CentrelineSegment& segment = segments_[segmentAt(chainage)];
  const double free = (chainage - segment.chainage) * segment.plan_length / segment.length;
  const double u = std::clamp(free, 0.0, segment.plan_length);
  const double heading = segment.headingAt(u);
  const Eigen::Vector2d plan = segment.planAt(u) + (free - u) * unit(heading);
  return {.p_map = {plan.x(), plan.y(), segment.start.z() + segment.grade * free},
          .heading = wrapAngle(heading),
          .grade = std::atan(segment.grade),
          .curvature = segment.curvature};
}

Centreline::Foot Centreline::footOnSegment(std::size_t segment_index, const Eigen::Vector3d& p_map) const {
  const CentrelineSegment& segment = segments_[segment_index];
  const SegmentFoot foot = footOn(segment, p_map);
  Foot result{.chainage = segment.chainage + foot.u * segment.length / segment.plan_length,
              .offset = foot.offset,
              .height = foot.height,
              .beyond = foot.beyond};
  const bool at_open_end =
      foot.u == 0.0 ? segment_index == 0 : segment_index + 1 == segments_.size();  // else at a kink
  if (foot.beyond > 0.0 && !at_open_end) {
    result.offset = std::copysign(std::hypot(foot.offset, foot.beyond), foot.offset);
    result.beyond = 0.0;
  }
  return result;
}

Centreline::Foot Centreline::foot(const Eigen::Vector3d& p_map) const {
  Foot best;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Foot foot = footOnSegment(i, p_map);
    const double distance = std::hypot(foot.offset, foot.beyond);
    if (distance >= nearest) continue;
    nearest = distance;
    best = foot;
  }
  return best;
}

}  // namespace pos::map
