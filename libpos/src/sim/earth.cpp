#include "pos/sim/earth.hpp"

#include <Eigen/Geometry>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>
#include <cmath>
#include <vector>

#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"

namespace pos::sim {

/// WGS84's normal gravity around the origin of the map.
struct Earth::Field {
  Eigen::Matrix3d R_ecef_map;
  Eigen::Vector3d p_ecef;

  /// Attraction and centrifugal: the gradient of the potential U.
  Eigen::Vector3d gravityAt(const Eigen::Vector3d& p_map) const {
    const Eigen::Vector3d p = p_ecef + R_ecef_map * p_map;
    Eigen::Vector3d g;
    GeographicLib::NormalGravity::WGS84().U(p.x(), p.y(), p.z(), g.x(), g.y(), g.z());
    return R_ecef_map.transpose() * g;
  }
};

Earth::Earth(const EarthConfig& config)
    : kind_(config.kind), gravity_(0.0, 0.0, -config.gravity), rotation_(0.0, 0.0, 0.0) {
  if (kind_ == EarthKind::Flat) {
    requirePositive(config.gravity, "gravity");
    return;
  }
  const map::GeodeticOrigin& origin = config.origin;
  if (!(std::abs(origin.latitude) <= 0.5 * kPi)) {
    refuse("the origin is no latitude", "origin.latitude", std::to_string(degrees(origin.latitude)),
           "-90 to 90 deg");
  }
  field_ = std::make_unique<Field>();
  std::vector<double> columns(9);  // row-major: east, north, up in ECEF axes
  GeographicLib::Geocentric::WGS84().Forward(degrees(origin.latitude), degrees(origin.longitude),
                                             origin.altitude, field_->p_ecef.x(), field_->p_ecef.y(),
                                             field_->p_ecef.z(), columns);
  const Eigen::Matrix3d R_ecef_enu = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(columns.data());
  const Eigen::Matrix3d R_enu_map =
      Eigen::AngleAxisd(origin.grid_rotation, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  field_->R_ecef_map = R_ecef_enu * R_enu_map;
  const double rate = GeographicLib::NormalGravity::WGS84().AngularVelocity();
  rotation_ = rate * field_->R_ecef_map.row(2).transpose();
  gravity_ = {0.0, 0.0, -field_->gravityAt(Eigen::Vector3d::Zero()).norm()};
}

Earth::~Earth() = default;
Earth::Earth(Earth&&) noexcept = default;
Earth& Earth::operator=(Earth&&) noexcept = default;

Eigen::Vector3d Earth::gravityAt(const Eigen::Vector3d& p_map) const {
  return kind_ == EarthKind::Ellipsoid ? field_->gravityAt(p_map) : gravity_;
}

}  // namespace pos::sim
