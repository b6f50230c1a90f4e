#pragma once
/// The strapdown: attitude, velocity and position from what gyros and accelerometers felt.
///
/// n = local level, east north up; b = body (FLU). C_n_b takes body to n. Jiang et al. 2024 section 5.1 with
/// the body axes turned from RFU to FLU.

#include <Eigen/Geometry>

#include "pos/ins/earth.hpp"

namespace pos::ins {

/// Where an inertial unit is, how it moves and how it stands.
struct NavigationState {
  Eigen::Quaterniond q_n_b = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_n = Eigen::Vector3d::Zero();  ///< m/s over ground
  /// Coordinates of the Earth model: metres (flat), or longitude rad, latitude rad, height m.
  Eigen::Vector3d coordinates = Eigen::Vector3d::Zero();

  Eigen::Matrix3d C_n_b() const { return q_n_b.toRotationMatrix(); }
};

/// Increments over one sample interval, biases taken off: rad and m/s in body axes.
struct ImuIncrement {
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  double dt = 0.0;  ///< s
};

/// The angle and velocity an increment amounts to when the axes turned and the force changed within it
/// (coning and sculling; two samples, Savage 1998): good to third order in the interval.
/// `previous` is the increment before, over an interval of the same length; zero at the first.
ImuIncrement compensated(const ImuIncrement& now, const ImuIncrement& previous);

/// The state one increment later. Rotation exact over the interval, velocity and position by the midpoint;
/// dt = 0 changes nothing. `increment` may be `compensated`.
NavigationState stepped(const Earth& earth, const NavigationState& state, const ImuIncrement& increment);

/// Time derivatives for a turn rate against the stars (rad/s) and a specific force (m/s^2), both in b: what
/// `stepped` integrates. For tests and for error models.
struct NavigationRates {
  Eigen::Matrix3d C_n_b;  ///< dC/dt = C [w_ib x] - [w_in x] C
  Eigen::Vector3d v_n;    ///< dv/dt = C f - (2 w_ie + w_en) x v + g
  Eigen::Vector3d p;      ///< d coordinates / dt
};
NavigationRates navigationRates(const Earth& earth, const NavigationState& state,
                                const Eigen::Vector3d& omega_ib_b, const Eigen::Vector3d& f_b);

/// From one set of coordinates to another, m east, north, up; for places near each other.
Eigen::Vector3d metresBetween(const Earth& earth, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// [a x], the matrix with [a x] b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

}  // namespace pos::ins
