#include "pos/sim/zone_changes.hpp"

#include <algorithm>
#include <functional>
#include <variant>

namespace pos::sim {
namespace {

constexpr double kStep = 0.05;      // s between looks
constexpr double kAccuracy = 1e-4;  // s

/// Index of the zone that counts at t; the number of zones where none does.
using ZoneAt = std::function<std::size_t(double)>;

template <class Zones>
std::size_t firstHolding(const Zones& zones, double t, const Eigen::Vector2d& p) {
  std::size_t i = 0;
  while (i < zones.size() && !zones[i].where.contains(t, p)) ++i;
  return i;
}

std::vector<double> changes(const ZoneAt& zone_at, double duration) {
  std::vector<double> all;
  double t = 0.0;
  std::size_t zone = zone_at(0.0);
  while (t < duration) {
    const double next = std::min(t + kStep, duration);
    const std::size_t zone_next = zone_at(next);
    if (zone_next != zone) {
      double before = t;
      double after = next;
      while (after - before > kAccuracy) {
        const double middle = 0.5 * (before + after);
        (zone_at(middle) == zone ? before : after) = middle;
      }
      all.push_back(after);
    }
    zone = zone_next;
    t = next;
  }
  return all;
}

struct ZonesOf {
  const Simulation& simulation;
  Eigen::Vector3d mount;  // m, of the sensor on the body

  ZoneAt operator()(const GnssConfig& gnss) const {
    return [this, zones = gnss.zones, lever = Eigen::Vector3d(gnss.antenna_body + mount)](double t) {
      const Kinematics body = simulation.truthAt(t);
      return firstHolding(zones, t, (body.p_map + body.R_map_body * lever).head<2>());
    };
  }
  ZoneAt operator()(const UwbConfig& uwb) const {
    return [this, zones = uwb.zones](double t) {
      return firstHolding(zones, t, simulation.truthAt(t).p_map.head<2>());
    };
  }
  template <class Other>
  ZoneAt operator()(const Other&) const {
    return {};
  }
};

}  // namespace

std::vector<Stamp> zoneChanges(const Scenario& scenario, const Simulation& simulation) {
  std::vector<Stamp> all;
  for (const SensorEntry& sensor : scenario.sensors) {
    const Eigen::Vector3d mount =
        sensor.mount.empty() ? Eigen::Vector3d::Zero() : scenario.vehicle.mount(sensor.mount).p_body;
    const ZonesOf zones_of{simulation, mount};
    const ZoneAt zone_at = std::visit(zones_of, sensor.model);
    if (!zone_at) continue;
    for (const double t : changes(zone_at, simulation.duration()))
      all.push_back(simulation.start() + durationFromSeconds(t));
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace pos::sim
