#pragma once
/// State and models of the inertial filter with support legs (docs/math/shearer.md). Memory is fixed: no call
/// here allocates.
///
/// Tangent [phi, v, p, gyro bias, accelerometer bias, scanner (0 or 6), leg 1, leg 2, ...]; truth = state (+)
/// tangent with C <- Exp(phi) C in n, everything else added; m, m/s, rad in n (the map's axes).

#include <Eigen/Core>
#include <array>
#include <optional>

#include "pos/core/verdict.hpp"
#include "pos/estimation/leg_sensor.hpp"
#include "pos/estimation/shearer_configs.hpp"
#include "pos/ins/error_model.hpp"

namespace pos::estimation {

inline constexpr int kMaxLegs = 12;
inline constexpr int kShearerRows = ins::kInertial + LegSensor::kDof + 3 * kMaxLegs;
using ShearerMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kShearerRows, kShearerRows>;
using ShearerVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kShearerRows, 1>;
/// Rows of a model of three numbers.
using ShearerRows3 = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kShearerRows>;

/// A point that stands still: a support's leg, or a stop at an end.
struct Landmark {
  int id = 0;
  Eigen::Vector3d p_n = Eigen::Vector3d::Zero();
  int rejected = 0;  ///< readings in a row
};

struct ShearerState {
  ins::Earth earth = ins::Earth::flat();
  ins::NavigationState nav;                                      ///< of the inertial unit
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           ///< rad/s, in the reading
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< m/s^2, in the reading
  LegSensor sensor;
  bool sensor_states = false;  ///< whether they are part of the tangent
  std::array<Landmark, kMaxLegs> landmarks;
  int landmark_count = 0;

  int dof() const { return rowOf(landmark_count); }
  int sensorRow() const { return ins::kInertial; }
  /// First row of landmark `index`.
  int rowOf(int index) const { return ins::kInertial + (sensor_states ? LegSensor::kDof : 0) + 3 * index; }
  std::optional<int> indexOf(int id) const;
};

struct ShearerBelief {
  ShearerState mean;
  ShearerMatrix covariance;
  /// d tangent / d yaw of the mount that nobody estimates (what PICM corrects with); empty when not carried.
  ShearerVector by_yaw;
};

/// A reading of three numbers: nu = reading - prediction, H = d prediction / d tangent, in n.
struct ShearerInnovation {
  Eigen::Vector3d nu = Eigen::Vector3d::Zero();
  ShearerRows3 H;
  Eigen::Vector3d by_yaw = Eigen::Vector3d::Zero();  ///< d (reading - prediction) / d yaw of the mount
};

/// One leg as the scanner gave it.
struct LegSight {
  Eigen::Vector3d measured = Eigen::Vector3d::Zero();        ///< m, scanner axes
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< m^2, scanner axes
  double age = 0.0;                                          ///< s by which it is later than the state
};

/// Adds a tangent to the state.
void inject(ShearerState& x, const ShearerVector& d);

/// The covariance carried over `dt` seconds in which the strapdown has moved the state from `before` to where
/// it is.
void propagate(ShearerBelief& belief, const ins::NavigationState& before, const ImuNoise& noise, double dt);

/// Where a leg stands by the state, m in n. `arm` (m, body) goes from the inertial unit to the scanner.
Eigen::Vector3d placeOf(const ShearerState& x, const LegSight& sight, const Eigen::Vector3d& arm);
/// The leg seen against landmark `index` (Zheng et al. 2021, eq. 19 to 24).
ShearerInnovation legInnovation(const ShearerState& x, const LegSight& sight, int index,
                                const Eigen::Vector3d& arm);
/// Where landmark `index` is seen in scanner axes.
Eigen::Vector3d expectedLeg(const ShearerState& x, int index, const Eigen::Vector3d& arm);
/// A point at `p_n` (m) as seen in scanner axes.
Eigen::Vector3d inScanner(const ShearerState& x, const Eigen::Vector3d& p_n, const Eigen::Vector3d& arm);
/// The inertial unit stands at landmark `index` + `offset` (m, n).
ShearerInnovation stopInnovation(const ShearerState& x, int index, const Eigen::Vector3d& offset);
/// The inertial unit stands at `p_n`.
ShearerInnovation placeInnovation(const ShearerState& x, const Eigen::Vector3d& p_n);

struct ShearerCorrection {
  Verdict verdict = Verdict::Applied;
  double nis = 0.0;
};
/// Takes a reading with noise R (n axes). What nothing has seen (turning everything about the vertical,
/// shifting everything) stays unseen: position errors are referred anew to the corrected attitude, so that a
/// common turn of vehicle and landmarks is one direction of the tangent before and after.
ShearerCorrection correct(ShearerBelief& belief, const ShearerInnovation& innovation,
                          const Eigen::Matrix3d& R, double gate);

/// How a landmark's first covariance comes about.
enum class Initialisation {
  Correlated,    ///< with that of the vehicle, as it is
  Uncorrelated,  ///< its own variance only: wrong, kept to show what comes of it
};
/// A new landmark where the sight puts it (eq. 11, with its covariance); the sight is then used up. False
/// when there is no room.
bool addLandmark(ShearerBelief& belief, int id, const LegSight& sight, const Eigen::Vector3d& arm,
                 Initialisation how = Initialisation::Correlated);
/// The inertial unit's own place as a landmark.
bool addStop(ShearerBelief& belief, int id);
/// Forgets a landmark; what the rest knows stays bit for bit.
void removeLandmark(ShearerBelief& belief, int index);

}  // namespace pos::estimation
