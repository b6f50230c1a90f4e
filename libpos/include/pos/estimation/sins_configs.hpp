#pragma once
/// Configuration of `sins_dr` and of the parts other inertial systems share. SI units, defaults of a MEMS
/// unit on a small car (Jiang et al. 2024; sensor grades are ours, docs/math/sins_dr.md).

#include <Eigen/Core>

#include "pos/estimation/calibration_state.hpp"
#include "pos/estimation/start_config.hpp"
#include "pos/filters/noise_adaptation.hpp"
#include "pos/ins/eskf.hpp"
#include "pos/ins/odometer.hpp"
#include "pos/ins/standstill.hpp"

namespace pos::estimation {

/// What the inertial unit does wrong, as its data sheet says.
struct ImuNoise {
  double gyro_density = 1.745e-4;            ///< rad/s/sqrt(Hz), angle random walk (0.01 deg/s/sqrt(Hz))
  double accelerometer_density = 1.96e-3;    ///< m/s^2/sqrt(Hz), velocity random walk (200 ug/sqrt(Hz))
  double gyro_bias_sigma = 3.5e-4;           ///< rad/s from switch-on to switch-on (0.02 deg/s)
  double accelerometer_bias_sigma = 0.0196;  ///< m/s^2 (2 mg)
  double gyro_bias_walk = 1e-6;              ///< rad/s per sqrt(s)
  double accelerometer_bias_walk = 1e-4;     ///< m/s^2 per sqrt(s)

  bool operator==(const ImuNoise&) const = default;
};

/// How the vehicle finds its level and its gyro bias before it moves off.
struct AlignmentConfig {
  double time = 5.0;                 ///< s of standing still before the first answer
  double level_sigma = 2e-4;         ///< rad, tilt beyond what the accelerometer bias explains
  double moving_level_sigma = 0.03;  ///< rad, tilt when the vehicle moved off before the time was up
  bool zero_rate = true;  ///< standing still shows the gyro bias; false: it is left unknown (a comparison)

  bool operator==(const AlignmentConfig&) const = default;
};

/// When wheels are not believed and how the way back is found (section 5.5 of the specification, after
/// Jiang et al. 2024 section 3.1).
struct SlipConfig {
  enum class Handling {
    None,     ///< every difference is believed
    Gate,     ///< the printed rule: the update is skipped, the odometer's position keeps the slipped way
    Isolate,  ///< wheels are left out until they agree again, then re-anchored
  } handling = Handling::Isolate;
  double confidence = 0.99;          ///< of the chi-square test with three degrees of freedom
  int window = 3;                    ///< updates looked at ...
  int exceedances = 2;               ///< ... of which this many must fail to isolate the wheels
  double release_confidence = 0.99;  ///< velocities agree when their test passes at this level ...
  int release_updates = 3;           ///< ... so many times in a row
  double release_yaw_rate = 0.1;     ///< rad/s, and wheels and gyro agree on the turn within this
  double velocity_sigma = 0.02;      ///< m/s, of the wheels' velocity in that test
  double degraded_after = 8.0;       ///< s without wheels: the position is called degraded
  double max_sigma = 0.5;            ///< m, gained without wheels: the inertial velocity is given up
  bool standstill_updates = true;    ///< while isolated and the inertial unit is quiet, the vehicle stands
  double lateral_sigma = 0.05;       ///< m/s, sideways and upward speed while isolated

  bool operator==(const SlipConfig&) const = default;
};

/// `Flat`: the map's axes, no Earth rotation (simulations of small sites). `Ellipsoid`: the map's tie to the
/// Earth is needed.
enum class EarthModel { Flat, Ellipsoid };

/// Where things sit on the body (m, FLU).
struct InertialMounts {
  Eigen::Vector3d imu = Eigen::Vector3d::Zero();
  Eigen::Vector3d axle = Eigen::Vector3d::Zero();  ///< middle of the axle whose wheels are read

  bool operator==(const InertialMounts&) const = default;
};

/// How `dead_reckoning` with `ekf_heading` weighs the inertial attitude against the wheels' turns.
struct HeadingFilterConfig {
  double level_walk = 0.0087;   ///< rad per sqrt(s), how climb and roll change
  double level_sigma = 0.0035;  ///< rad, of the climb and roll seen
  double yaw_sigma = 0.0175;    ///< rad, of the inertial heading
  /// s during which the error of that heading stays the same, so that its readings are not news each time:
  /// the variance counts (this over the interval between readings) times. 0: white.
  double correlation_time = 40.0;
  CalibrationState yaw_bias{0.0, 0.0, 0.0};     ///< rad, state: the inertial heading reads too much
  CalibrationState track_error{0.0, 0.0, 0.0};  ///< state: the track is too large by this share

  bool operator==(const HeadingFilterConfig&) const = default;
};

struct SinsDrConfig {
  /// `ekf`: fixed measurement noise. `iaekf`: learnt on the way.
  enum class Variant { Ekf, Iaekf } variant = Variant::Iaekf;
  StartConfig start;    ///< known position and heading; height in `height`
  double height = 0.0;  ///< m, of the body frame in the map at the start
  EarthModel earth = EarthModel::Flat;
  ImuNoise imu;
  InertialMounts mounts;
  AlignmentConfig alignment;
  ins::StandstillConfig standstill;
  ins::OdometerConfig odometer;
  double odometer_scale_sigma = 0.02;      ///< -
  double odometer_scale_walk = 1e-5;       ///< per sqrt(s)
  double odometer_velocity_sigma = 0.003;  ///< m/s per reading, white, each axis
  double boresight_sigma = 0.0;        ///< rad, mounting pitch and yaw of the unit against the axle; 0: none
  double wheels_lost_after = 1.0;      ///< s without wheels: the inertial solution goes on alone, and says so
  double update_interval = 0.1;        ///< s between comparisons of the two positions
  double propagation_interval = 0.05;  ///< s between steps of the covariance
  double difference_sigma = 0.02;      ///< m, noise of the difference of the two positions, sqrt(R_0)
  double difference_sigma_min = 0.01;  ///< m, floor of the learnt noise
  double difference_sigma_max = 1.0;   ///< m
  filters::NoiseForm noise_form = filters::NoiseForm::Residual;
  double forgetting = 0.98;
  double zero_velocity_sigma = 0.02;  ///< m/s, standing still
  double fix_confidence = 0.999;      ///< of the gate on outside fixes
  SlipConfig slip;

  bool operator==(const SinsDrConfig&) const = default;
};

/// The process noise of an error-state filter with this unit, in a field of `gravity` m/s^2.
ins::EskfProcess processOf(const ImuNoise& imu, double gravity);
ImuNoise validated(ImuNoise config);
AlignmentConfig validated(AlignmentConfig config);
SlipConfig validated(SlipConfig config);
HeadingFilterConfig validated(HeadingFilterConfig config);
SinsDrConfig validated(SinsDrConfig config);

}  // namespace pos::estimation
