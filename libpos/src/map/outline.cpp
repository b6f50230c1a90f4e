#include "pos/map/outline.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/angle.hpp"

namespace pos::map {
namespace {

/// Steps of an arc whose chords stay within `tolerance`: sagitta = R (1 - cos(step / 2)).
std::size_t stepsOf(const CentrelineSegment& segment, double tolerance, double reach) {
  const double curvature = std::abs(segment.curvature);
  if (curvature == 0.0) return 1;
  const double radius = 1.0 / curvature + std::abs(reach);
  const double step = 2.0 * std::acos(std::max(0.0, 1.0 - tolerance / radius));
  const double swept = curvature * segment.plan_length;
  return static_cast<std::size_t>(std::clamp(std::ceil(swept / step), 1.0, 1e4));
}

/// Direction and length of the mitre where the heading jumps at a surveyed point: the bisector, longer by
/// 1 / cos(half the kink), at most twice as long.
Eigen::Vector2d mitre(const Centreline& centreline, double chainage) {
  const std::size_t after = centreline.segmentAt(chainage);
  const CentrelineSegment& segment = centreline.segments()[after];
  double heading = centreline.at(chainage).heading;
  double stretch = 1.0;
  if (after > 0 && std::abs(chainage - segment.chainage) < 1e-9) {
    const CentrelineSegment& before = centreline.segments()[after - 1];
    const double half = 0.5 * wrapAngle(segment.heading - before.headingAt(before.plan_length));
    heading = segment.heading - half;
    stretch = 1.0 / std::max(0.5, std::cos(half));
  }
  return stretch * Eigen::Vector2d(-std::sin(heading), std::cos(heading));
}

}  // namespace

std::vector<double> sampleChainages(const Centreline& centreline, double from, double to, double tolerance,
                                    double reach) {
  const double low = std::min(from, to);
  const double high = std::max(from, to);
  std::vector<double> chainages{low};
  for (const CentrelineSegment& segment : centreline.segments()) {
    const std::size_t steps = stepsOf(segment, tolerance, reach);
    for (std::size_t k = 0; k < steps; ++k) {
      const double chainage =
          segment.chainage + segment.length * static_cast<double>(k) / static_cast<double>(steps);
      if (chainage > low + 1e-9 && chainage < high - 1e-9) chainages.push_back(chainage);
    }
  }
  chainages.push_back(high);
  if (from > to) std::reverse(chainages.begin(), chainages.end());
  return chainages;
}

PlanLine offsetLine(const Centreline& centreline, const std::vector<double>& chainages, double offset) {
  PlanLine line;
  line.reserve(chainages.size());
  for (const double chainage : chainages) {
    line.push_back(centreline.at(chainage).p_map.head<2>() + offset * mitre(centreline, chainage));
  }
  return line;
}

PlanLine strip(const Centreline& centreline, double from, double to, double left_offset, double right_offset,
               double tolerance) {
  const double reach = std::max(std::abs(left_offset), std::abs(right_offset));
  const auto chainages = sampleChainages(centreline, from, to, tolerance, reach);
  PlanLine polygon = offsetLine(centreline, chainages, left_offset);
  const PlanLine right = offsetLine(centreline, chainages, right_offset);
  polygon.insert(polygon.end(), right.rbegin(), right.rend());
  return polygon;
}

PlanLine chamberOutline(const Roadway& roadway, const Centreline& centreline, const Chamber& chamber,
                        double tolerance, double overlap) {
  const double sign = chamber.side == Side::Left ? 1.0 : -1.0;
  const double wall = 0.5 * roadway.width;
  return strip(centreline, chamber.place.chainage - 0.5 * chamber.length,
               chamber.place.chainage + 0.5 * chamber.length, sign * (wall + chamber.depth),
               sign * (wall - overlap), tolerance);
}

}  // namespace pos::map
