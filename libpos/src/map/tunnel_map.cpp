#include "pos/map/tunnel_map.hpp"

#include <Eigen/Geometry>

namespace pos::map {
namespace {

template <class Object, class Id>
const Object* found(const std::vector<Object>& objects, const Id& id) {
  for (const Object& object : objects) {
    if (object.id == id) return &object;
  }
  return nullptr;
}

}  // namespace

const Anchor* TunnelMap::findAnchor(AnchorId id) const {
  return found(anchors, id);
}
const Roadway* TunnelMap::findRoadway(const std::string& id) const {
  return found(roadways, id);
}
const Chamber* TunnelMap::findChamber(const std::string& id) const {
  return found(chambers, id);
}
const Junction* TunnelMap::findJunction(const std::string& id) const {
  return found(junctions, id);
}
const Route* TunnelMap::findRoute(const std::string& id) const {
  return found(routes, id);
}

Eigen::Vector3d toGrid(const MineGrid& grid, const Eigen::Vector3d& p_map) {
  const Eigen::AngleAxisd turn(grid.rotation, Eigen::Vector3d::UnitZ());
  return Eigen::Vector3d(grid.easting, grid.northing, grid.elevation) + turn * p_map;
}

Eigen::Vector3d fromGrid(const MineGrid& grid, const Eigen::Vector3d& p_grid) {
  const Eigen::AngleAxisd turn_back(-grid.rotation, Eigen::Vector3d::UnitZ());
  return turn_back * (p_grid - Eigen::Vector3d(grid.easting, grid.northing, grid.elevation));
}

}  // namespace pos::map
