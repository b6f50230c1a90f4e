#include "volume.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/angle.hpp"

namespace pos::map {
namespace {

/// How far the chord of an arc may leave it, m.
constexpr double kSagitta = 0.01;

Eigen::Vector2d leftOf(const Eigen::Vector2d& axis) {
  return {-axis.y(), axis.x()};
}

/// Slices of one segment without regard to its neighbours.
std::vector<Volume> slicesOf(const CentrelineSegment& segment, const Roadway& roadway) {
  const double swept = std::abs(segment.curvature) * segment.plan_length;
  const double radius = segment.curvature == 0.0 ? 0.0 : 1.0 / std::abs(segment.curvature);
  const double outer = radius + 0.5 * roadway.width;
  const double step = swept == 0.0 ? 1.0 : 2.0 * std::acos(std::max(0.9, 1.0 - kSagitta / outer));
  const int count = std::max(1, static_cast<int>(std::ceil(swept / step)));
  const double mitre = 0.5 * roadway.width * std::tan(0.5 * swept / count);
  const double sagitta = outer * (1.0 - std::cos(0.5 * swept / count));
  std::vector<Volume> volumes;
  for (int i = 0; i < count; ++i) {
    const double u = segment.plan_length * i / count;
    const double v = segment.plan_length * (i + 1) / count;
    const Eigen::Vector2d a = segment.planAt(u);
    const Eigen::Vector2d chord = segment.planAt(v) - a;
    const double length = chord.norm();
    const double rise = segment.grade * (v - u);
    volumes.push_back({.origin = {a.x(), a.y(), segment.start.z() + segment.grade * u},
                       .axis = chord / length,
                       .s_min = i == 0 ? 0.0 : -mitre,
                       .s_max = i + 1 == count ? length : length + mitre,
                       .n_min = -0.5 * roadway.width - (segment.curvature > 0.0 ? sagitta : 0.0),
                       .n_max = 0.5 * roadway.width + (segment.curvature < 0.0 ? sagitta : 0.0),
                       .grade = rise / length,
                       .height = roadway.height,
                       .arch_radius = roadway.section == Section::Arch ? 0.5 * roadway.width : 0.0});
  }
  return volumes;
}

/// How far two slices have to reach past the kink between them to fill the outer corner.
double reachPast(const Volume& before, const Volume& after, double width) {
  const double turn = std::abs(std::atan2(leftOf(before.axis).dot(after.axis), before.axis.dot(after.axis)));
  return 0.5 * width * std::tan(0.5 * std::min(turn, 0.5 * kPi));
}

/// Keeps the part of [part] in which low <= from + share * step <= high.
bool clip(Part& part, double from, double step, double low, double high) {
  if (std::abs(step) < 1e-12) return from >= low && from <= high;
  const double a = (low - from) / step;
  const double b = (high - from) / step;
  part.begin = std::max(part.begin, std::min(a, b));
  part.end = std::min(part.end, std::max(a, b));
  return part.begin <= part.end;
}

}  // namespace

Eigen::Vector3d Volume::local(const Eigen::Vector3d& p_map) const {
  const Eigen::Vector2d d = (p_map - origin).head<2>();
  const double s = axis.dot(d);
  return {s, leftOf(axis).dot(d), p_map.z() - origin.z() - grade * s};
}

Box Volume::box() const {
  Box box;
  for (const double s : {s_min, s_max}) {
    for (const double n : {n_min, n_max}) {
      const Eigen::Vector2d plan = origin.head<2>() + s * axis + n * leftOf(axis);
      const double floor = origin.z() + grade * s;
      box.extend(Eigen::Vector3d(plan.x(), plan.y(), floor));
      box.extend(Eigen::Vector3d(plan.x(), plan.y(), floor + height));
    }
  }
  return box;
}

bool Volume::holds(const Eigen::Vector3d& p_map, double slack) const {
  const Eigen::Vector3d local_point = local(p_map);
  const double s = local_point.x();
  const double n = local_point.y();
  const double h = local_point.z();
  if (s < s_min - slack || s > s_max + slack || n < n_min - slack || n > n_max + slack || h < -slack ||
      h > height + slack) {
    return false;
  }
  const double springing = height - arch_radius;
  return arch_radius == 0.0 || h <= springing || std::hypot(n, h - springing) <= arch_radius + slack;
}

std::optional<Part> partInside(const Volume& volume, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               double slack) {
  const Eigen::Vector3d from = volume.local(a);
  const Eigen::Vector3d step = volume.local(b) - from;
  Part part;
  const bool inside = clip(part, from.x(), step.x(), volume.s_min - slack, volume.s_max + slack) &&
                      clip(part, from.y(), step.y(), volume.n_min - slack, volume.n_max + slack) &&
                      clip(part, from.z(), step.z(), -slack, volume.height + slack);
  return inside ? std::optional(part) : std::nullopt;
}

std::vector<Volume> slices(const Roadway& roadway, const Centreline& centreline) {
  std::vector<Volume> all;
  for (const CentrelineSegment& segment : centreline.segments()) {
    std::vector<Volume> next = slicesOf(segment, roadway);
    if (!all.empty()) {
      const double reach = reachPast(all.back(), next.front(), roadway.width);
      all.back().s_max += reach;
      next.front().s_min -= reach;
    }
    all.insert(all.end(), next.begin(), next.end());
  }
  return all;
}

Volume niche(const Chamber& chamber, const Roadway& roadway, const Centreline& centreline) {
  const CentrelineState middle = centreline.at(chamber.place.chainage);
  const double back = 0.5 * roadway.width + chamber.depth;
  const bool left = chamber.side == Side::Left;
  return {.origin = middle.p_map,
          .axis = {std::cos(middle.heading), std::sin(middle.heading)},
          .s_min = -0.5 * chamber.length,
          .s_max = 0.5 * chamber.length,
          .n_min = left ? 0.0 : -back,
          .n_max = left ? back : 0.0,
          .grade = std::tan(middle.grade),
          .height = roadway.section == Section::Arch ? roadway.height - 0.5 * roadway.width : roadway.height};
}

}  // namespace pos::map
