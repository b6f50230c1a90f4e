#include "pos/sim/support_legs.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/config_checks.hpp"

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

LegSlice::LegSlice(const LegCylinder& leg) : axis_(leg.axis.head<2>()) {
  const Eigen::Vector3d across = leg.point - leg.axis * leg.axis.dot(leg.point);
  across_ = across.head<2>();
  c_ = across.squaredNorm() - leg.radius * leg.radius;
}

std::optional<double> LegSlice::beamRange(const Eigen::Vector2d& direction) const {
  // Beam s u and axis point m, both without their part along the axis: |s u' - m'|^2 = r^2, that is
  // a s^2 - 2 b s + c = 0 with a = |u'|^2 = 1 - (u . axis)^2 and b = u' . m' = u . m'.
  const double slant = axis_.dot(direction);
  const double a = 1.0 - slant * slant;
  const double b = across_.dot(direction);
  const double root = b * b - a * c_;
  if (c_ <= 0.0 || b <= 0.0 || root < 0.0) return {};
  return (b - std::sqrt(root)) / a;
}

std::optional<double> beamRange(const LegCylinder& leg, double angle) {
  return LegSlice(leg).beamRange({std::cos(angle), std::sin(angle)});
}

LegEllipse cutByScanPlane(const LegCylinder& leg) {
  const Eigen::Vector3d centre = leg.point - leg.axis * (leg.point.z() / leg.axis.z());
  return {.centre = centre.head<2>(),
          .semi_minor = leg.radius,
          .semi_major = leg.radius / std::abs(leg.axis.z())};
}

}  // namespace pos::sim
