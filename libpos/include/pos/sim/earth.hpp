#pragma once
/// The Earth under the simulated map: gravity and rotation as an inertial sensor feels them.

#include <Eigen/Core>
#include <memory>

#include "pos/map/tunnel_map.hpp"

namespace pos::sim {

enum class EarthKind {
  Flat,      ///< constant gravity along -z, no rotation
  Level,     ///< constant gravity along -z at the latitude, and the Earth's rotation
  Ellipsoid  ///< WGS84 normal gravity at the place itself (it turns with the plumb line), and the rotation
};

struct EarthConfig {
  EarthKind kind = EarthKind::Flat;
  double gravity = 9.80665;         ///< m/s^2, Flat only
  map::GeodeticOrigin origin = {};  ///< of the map; Level and Ellipsoid

  bool operator==(const EarthConfig&) const = default;
};

/// What is needed of the Earth at a place.
class Earth {
 public:
  /// Throws ConfigError for a latitude that is none.
  explicit Earth(const EarthConfig& config);
  ~Earth();
  Earth(Earth&&) noexcept;
  Earth& operator=(Earth&&) noexcept;

  /// m/s^2 in map axes at a map point: attraction and centrifugal together; the plumb line.
  Eigen::Vector3d gravityAt(const Eigen::Vector3d& p_map) const;
  /// rad/s, the map against the stars, in map axes.
  const Eigen::Vector3d& rotation() const { return rotation_; }

 private:
  struct Field;
  EarthKind kind_;
  Eigen::Vector3d gravity_;
  Eigen::Vector3d rotation_;
  std::unique_ptr<Field> field_;
};

}  // namespace pos::sim
