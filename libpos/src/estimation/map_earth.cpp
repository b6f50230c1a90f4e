#include "pos/estimation/map_earth.hpp"

#include <Eigen/Geometry>

#include "pos/core/error.hpp"

namespace pos::estimation {

MapEarth::MapEarth(const ins::Earth& earth, const map::TunnelMap& map, const std::string& key)
    : earth_(earth) {
  if (earth.isFlat()) return;
  if (!map.origin) {
    throw ConfigError(
        Complaint{.what = "the Earth's ellipsoid needs the map's tie to the Earth, and it has none",
                  .key = key,
                  .expected = "a map with an origin (latitude, longitude, altitude)",
                  .suggestion = "add the origin to the map, or say flat"});
  }
  frame_.emplace(*map.origin);
}

Eigen::Vector3d MapEarth::coordinates(const Eigen::Vector3d& p_map) const {
  if (!frame_) return p_map;
  const map::GeodeticOrigin q = frame_->toGeodetic(p_map);
  return {q.longitude, q.latitude, q.altitude};
}

Eigen::Vector3d MapEarth::position(const Eigen::Vector3d& q) const {
  return frame_ ? frame_->fromGeodetic(q.y(), q.x(), q.z()) : q;
}

Eigen::Matrix3d MapEarth::R_map_n(const Eigen::Vector3d& q) const {
  if (!frame_) return Eigen::Matrix3d::Identity();
  // Ten metres along each coordinate: straight to 1e-6 on an Earth of 6,400 km.
  const Eigen::Vector3d metric = earth_.at(q).metric;
  const auto along = [&](int axis) -> Eigen::Vector3d {
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    d[axis] = 10.0 / metric[axis];
    return position(q + d) - position(q - d);
  };
  const Eigen::Vector3d up = along(2).normalized();
  const Eigen::Vector3d east = (along(0) - along(0).dot(up) * up).normalized();
  Eigen::Matrix3d R;
  R << east, up.cross(east), up;
  return R;
}

}  // namespace pos::estimation
