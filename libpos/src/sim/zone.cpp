#include "pos/sim/zone.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::sim {

bool inside(const Outline& outline, const Eigen::Vector2d& p) {
  bool in = false;
  for (std::size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[j];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) in = !in;
  }
  return in;
}

bool Zone::contains(double t, const Eigen::Vector2d& p) const {
  return (!time || time->contains(t)) && (place.empty() || inside(place, p));
}

double Zone::progress(double t, const Eigen::Vector2d& p) const {
  double u = 0.0;
  if (ramp_from) {
    const Eigen::Vector2d way = *ramp_to - *ramp_from;
    u = (p - *ramp_from).dot(way) / way.squaredNorm();
  } else if (time) {
    u = (t - time->from) / (time->to - time->from);
  }
  return std::clamp(u, 0.0, 1.0);
}

Zone validated(Zone zone, const std::string& key) {
  if (zone.time) requireSpan(*zone.time, key + ".time");
  require(zone.place.empty() || zone.place.size() >= 3, key + ".place", "an outline of three points or more");
  require(zone.ramp_from.has_value() == zone.ramp_to.has_value(), key + ".ramp",
          "both ends of the ramp, or none");
  if (zone.ramp_from) {
    require((*zone.ramp_to - *zone.ramp_from).norm() > 0.0, key + ".ramp", "two different ends");
  }
  return zone;
}

double SigmaRamp::at(double progress) const {
  if (first == last) return first;
  return first * std::pow(last / first, progress);
}

}  // namespace pos::sim
