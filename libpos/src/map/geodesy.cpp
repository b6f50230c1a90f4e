#include "pos/map/geodesy.hpp"

#include <GeographicLib/LocalCartesian.hpp>

#include "pos/core/angle.hpp"

namespace pos::map {
namespace {

GeographicLib::LocalCartesian cartesian(const GeodeticOrigin& origin) {
  return {degrees(origin.latitude), degrees(origin.longitude), origin.altitude};
}

}  // namespace

Eigen::Vector3d LocalFrame::fromGeodetic(double latitude, double longitude, double altitude) const {
  Eigen::Vector3d enu;
  cartesian(origin_).Forward(degrees(latitude), degrees(longitude), altitude, enu.x(), enu.y(), enu.z());
  enu.head<2>() = rotation2(-origin_.grid_rotation) * enu.head<2>();
  return origin_.p_map + enu;
}

GeodeticOrigin LocalFrame::toGeodetic(const Eigen::Vector3d& p_map) const {
  Eigen::Vector3d enu = p_map - origin_.p_map;
  enu.head<2>() = rotation2(origin_.grid_rotation) * enu.head<2>();
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  GeodeticOrigin point;
  cartesian(origin_).Reverse(enu.x(), enu.y(), enu.z(), latitude_deg, longitude_deg, point.altitude);
  point.latitude = radians(latitude_deg);
  point.longitude = radians(longitude_deg);
  return point;
}

}  // namespace pos::map
