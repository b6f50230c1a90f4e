#pragma once
/// Where the simulated vehicle truly is, by formula: nothing here integrates what a filter integrates.
///
/// Frames: map is ENU (or flat), body is FLU. Times are seconds since the scenario's start.

#include <Eigen/Core>
#include <vector>

namespace pos::sim {

/// Everything about the body at one moment. Derivatives are exact, not differences.
struct Kinematics {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();           ///< m, body origin
  Eigen::Vector3d v_map = Eigen::Vector3d::Zero();           ///< m/s
  Eigen::Vector3d a_map = Eigen::Vector3d::Zero();           ///< m/s^2
  Eigen::Matrix3d R_map_body = Eigen::Matrix3d::Identity();  ///< columns are the body axes in the map
  Eigen::Vector3d omega_body = Eigen::Vector3d::Zero();      ///< rad/s, body against map, in body axes
  Eigen::Vector3d alpha_body = Eigen::Vector3d::Zero();      ///< rad/s^2, time derivative of omega_body
};

/// A motion known at any time of [0, duration].
class Motion {
 public:
  Motion() = default;
  Motion(const Motion&) = delete;
  Motion& operator=(const Motion&) = delete;
  Motion(Motion&&) = delete;
  Motion& operator=(Motion&&) = delete;
  virtual ~Motion() = default;

  /// The body at `t` seconds; outside [0, duration] it stands still at the nearer end.
  virtual Kinematics at(double t) const = 0;
  virtual double duration() const = 0;
  /// Distance the body origin has travelled since 0, m, signed (backward travel counts down).
  virtual double travelled(double t) const = 0;
  /// Times in (0, duration) at which a derivative in Kinematics jumps (ends of ramps, of arcs), ascending.
  /// Quadrature over an interval splits there.
  virtual const std::vector<double>& breaks() const = 0;
};

}  // namespace pos::sim
