#include "pos/estimation/portal_zones.hpp"

#include <algorithm>
#include <cmath>

namespace pos::estimation {
namespace {

constexpr double kTooUnsure = 10.0;     // m
constexpr double kBesideTheRoad = 2.0;  // m off the cross-section, where the floor is still told

/// How far beyond the hand-over zone, on the side of the rock: positive under ground, m.
double beyondDark(const map::Portal& portal, double chainage) {
  const double place = portal.place.chainage;
  const bool dark_ahead = std::abs(place - portal.handover_from) <= std::abs(place - portal.handover_to);
  return dark_ahead ? chainage - portal.handover_to : portal.handover_from - chainage;
}

}  // namespace

PortalZones::PortalZones(const std::shared_ptr<const map::TunnelMap>& map) {
  if (map != nullptr && !map->roadways.empty()) network_.emplace(map);
}

Zone PortalZones::at(const Eigen::Vector3d& p_map, double sigma, double margin) const {
  if (!network_ || network_->map().portals.empty() || sigma > kTooUnsure) return Zone::Unknown;
  const auto here = network_->project(p_map);
  if (!here) return Zone::Unknown;
  const std::string& id = network_->map().roadways[here->point.roadway].id;
  bool has_portal = false;
  double dark = 0.0;    // m into the dark, of the nearest portal
  double length = 0.0;  // m, of its hand-over zone
  for (const map::Portal& portal : network_->map().portals) {
    if (portal.place.roadway != id) continue;
    const double beyond = beyondDark(portal, here->point.chainage);
    if (has_portal && std::abs(beyond) >= std::abs(dark)) continue;
    has_portal = true;
    dark = beyond;
    length = portal.handover_to - portal.handover_from;
  }
  if (!has_portal) return Zone::Underground;
  if (dark > margin + 3.0 * sigma) return Zone::Underground;
  return dark > -length ? Zone::Handover : Zone::Surface;
}

std::optional<double> PortalZones::floorAt(const Eigen::Vector3d& p_map) const {
  if (!network_) return std::nullopt;
  const auto here = network_->project(p_map);
  if (!here || here->beyond > 0.0 || here->excess > kBesideTheRoad) return std::nullopt;
  map::TunnelPoint middle = here->point;
  middle.offset = 0.0;
  middle.height = 0.0;
  return network_->toMap(middle).z();
}

}  // namespace pos::estimation
