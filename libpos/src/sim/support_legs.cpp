#include "pos/sim/support_legs.hpp"

#include <algorithm>
#include <cmath>

#include "pos/sim/checks.hpp"

namespace pos::sim {

SupportRow validated(SupportRow row, const std::string& key) {
  require(row.count >= 1, key + ".count", ">= 1");
  requirePositive(row.spacing, key + ".spacing", "m");
  requireFinite(row.station_first, key + ".station_first", "m");
  require(row.origin_map.allFinite(), key + ".origin_map", "two numbers, m");
  require(std::abs(row.along_map.norm() - 1.0) < 1e-9, key + ".along_map", "a unit vector");
  requirePositive(row.radius, key + ".radius", "m");
  require(std::abs(row.tilt) < 1.0, key + ".tilt", "less than 1 rad off the vertical");
  requireFinite(row.tilt_heading, key + ".tilt_heading", "rad");
  requireNotNegative(row.station_slack, key + ".station_slack", "m");
  return row;
}

LegPlacer straightRow(const SupportRow& row, double lateral, double advance,
                      std::vector<double> advance_times) {
  const Eigen::Vector2d left(-row.along_map.y(), row.along_map.x());
  return [row, left, lateral, advance, times = std::move(advance_times)](int support, double t) {
    const auto moves = std::upper_bound(times.begin(), times.end(), t) - times.begin();
    const double station = row.station_first + support * row.spacing;
    const Eigen::Vector2d p =
        row.origin_map + station * row.along_map + (lateral - advance * static_cast<double>(moves)) * left;
    return Eigen::Vector3d(p.x(), p.y(), 0.0);
  };
}

SupportSpan supportsNear(const SupportRow& row, double station, double reach) {
  const double middle = (station - row.station_first) / row.spacing;
  const double half = (reach + row.station_slack) / row.spacing;
  const double last = row.count;
  return {.first = static_cast<int>(std::clamp(std::ceil(middle - half), 0.0, last)),
          .last = static_cast<int>(std::clamp(std::floor(middle + half) + 1.0, 0.0, last))};
}

std::optional<double> beamRange(const LegCylinder& leg, double angle) {
  // Beam s u against the cylinder, both seen along its axis: |s u' - c'| = r.
  const Eigen::Vector3d u(std::cos(angle), std::sin(angle), 0.0);
  const Eigen::Vector3d u_across = u - leg.axis * leg.axis.dot(u);
  const Eigen::Vector3d c_across = leg.point - leg.axis * leg.axis.dot(leg.point);
  const double a = u_across.squaredNorm();
  const double b = u_across.dot(c_across);
  const double c = c_across.squaredNorm() - leg.radius * leg.radius;
  const double root = b * b - a * c;
  if (c <= 0.0 || b <= 0.0 || root < 0.0) return {};
  return (b - std::sqrt(root)) / a;
}

LegEllipse cutByScanPlane(const LegCylinder& leg) {
  const Eigen::Vector3d centre = leg.point - leg.axis * (leg.point.z() / leg.axis.z());
  return {.centre = centre.head<2>(),
          .semi_minor = leg.radius,
          .semi_major = leg.radius / std::abs(leg.axis.z())};
}

}  // namespace pos::sim
