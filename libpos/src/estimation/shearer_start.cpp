// The Earth below the face, and what an alignment leaves behind.
#include <cmath>

#include "parts.hpp"
#include "pos/core/error.hpp"
#include "pos/estimation/shearer.hpp"

namespace pos::estimation {

using ins::kAccelerometerBias;
using ins::kGyroBias;
using ins::kPhi;
using ins::kPosition;
using ins::kVelocity;

ins::Earth shearerEarth(const ShearerConfig& config, const map::TunnelMap& map) {
  if (config.earth == ShearerConfig::Earth::Flat) return ins::Earth::flat();
  if (!map.origin) {
    throw ConfigError(Complaint{.what = "an Earth that turns needs the map's tie to it, and the map has none",
                                .key = "earth",
                                .got = map.name.empty() ? "no map" : "map " + map.name,
                                .expected = "a map with an origin (latitude, longitude, altitude)",
                                .suggestion = "add the origin to the map, or say flat"});
  }
  const map::GeodeticOrigin& o = *map.origin;
  const double north = ins::kEarthRate * std::cos(o.latitude);
  const double up = ins::kEarthRate * std::sin(o.latitude);
  // North lies `grid_rotation` to the right of what would be the map's y axis.
  return ins::Earth::level({north * std::sin(o.grid_rotation), north * std::cos(o.grid_rotation), up},
                           ins::normalGravity(o.latitude, o.altitude));
}

ins::NavigationState shearerStart(const ShearerConfig& config, const std::optional<Belief<Pose2>>& given) {
  const ShearerAlignment& aligned = config.alignment;
  const Pose2 at = given ? given->mean : config.start.pose;
  const Pose3 T_map_body =
      Pose3::fromXyzYawPitchRoll(at.x, at.y, aligned.height, at.yaw, -aligned.pitch, aligned.roll);
  ins::NavigationState nav;
  nav.q_n_b = T_map_body.rotation;
  nav.coordinates = T_map_body * config.imu_place;
  nav.v_n = aligned.speed * (T_map_body.rotation * Eigen::Vector3d::UnitX());
  return nav;
}

Eigen::Matrix<double, 15, 15> shearerStartCovariance(const ShearerConfig& config,
                                                     const std::optional<Belief<Pose2>>& given) {
  const ShearerAlignment& aligned = config.alignment;
  const Belief<Pose2> at = given ? *given : knownStart(config.start);
  Eigen::Matrix<double, 15, 15> P = Eigen::Matrix<double, 15, 15>::Zero();
  P.diagonal().segment<3>(kPhi) << square(aligned.tilt_sigma), square(aligned.tilt_sigma),
      at.covariance(2, 2);
  P.diagonal().segment<3>(kVelocity).setConstant(square(aligned.speed_sigma));
  P.block<2, 2>(kPosition, kPosition) = at.covariance.topLeftCorner<2, 2>();
  P(kPosition + 2, kPosition + 2) = square(config.start.position_sigma);
  P.diagonal().segment<3>(kGyroBias).setConstant(square(config.imu.gyro_bias_sigma));
  P.diagonal().segment<3>(kAccelerometerBias).setConstant(square(config.imu.accelerometer_bias_sigma));
  return P;
}

}  // namespace pos::estimation
