#pragma once
/// Configuration of `uwb_imu`. SI units; defaults of an automotive inertial unit and a radio with a clear
/// view (docs/math/eskf.md tells which are the paper's).

#include <vector>

#include "pos/estimation/anchor_bias_config.hpp"
#include "pos/estimation/sins_configs.hpp"
#include "pos/estimation/tag_mount.hpp"
#include "pos/filters/robust_weight.hpp"

namespace pos::estimation {

/// What is known of level and speed when the first answer is due.
struct InertialStart {
  enum class Levelling {
    AtRest,    ///< stands first; level and gyro bias from the average
    InMotion,  ///< drives already: level body, speed as given
  } levelling = Levelling::AtRest;
  double speed = 0.0;           ///< m/s, forward, InMotion
  double velocity_sigma = 0.1;  ///< m/s, per axis
  double tilt_sigma = 0.01745;  ///< rad, roll and pitch, InMotion
  double height_sigma = 0.1;    ///< m
  bool operator==(const InertialStart&) const = default;
};

/// What else is known of the motion. 0 = not used.
struct MotionAids {
  double height_sigma = 0.0;         ///< m, the body frame keeps the height it started with
  double zero_velocity_sigma = 0.0;  ///< m/s, at standstill; then the gyros' mean is their bias, too
  double lateral_sigma = 0.0;        ///< m/s, sideways and upward speed of the axle that does not steer
  double wheel_speed_sigma = 0.0;    ///< m/s
  double interval = 0.1;             ///< s between two of the same kind

  bool operator==(const MotionAids&) const = default;
};

/// When all anchors are rejected for a while, the filter doubts itself.
struct RecoveryConfig {
  double after = 2.0;  ///< s without an accepted range while ranges come
  /// Of the anchors heard in that time, as many as this share must be accepted for the filter not to be lost.
  double agreement_fraction = 0.34;

  bool operator==(const RecoveryConfig&) const = default;
};

struct UwbImuConfig {
  enum class Variant {
    UwbOnly,  ///< a fix of its own for each epoch of ranges, no inertial unit
    Ekf,      ///< 16 states, quaternion additive
    Ukf,      ///< sigma points on the manifold
    Eskf,     ///< error-state filter, 15 states
  } variant = Variant::Eskf;
  StartConfig start;
  double height = 0.0;  ///< m, of the body frame in the map at the start
  InertialStart first;
  ImuNoise imu{2e-4, 2e-3, 5e-4, 0.02, 1e-6, 1e-4};
  InertialMounts mounts;
  AlignmentConfig alignment{2.0, 2e-4, 0.03, true};
  ins::StandstillConfig standstill;
  ins::OdometerConfig odometer;
  std::vector<TagMount> tags;  ///< the tags used; none: all, where the log says they sit
  double range_sigma = 0.1;    ///< m
  double range_max = 300.0;    ///< m, no radio of this kind reads more
  filters::RobustConfig robust;
  double power_gap_db =
      0.0;  ///< dB between total and first-path power that make a range doubtful; 0 = not looked at
  double power_factor = 4.0;     ///< on the variance of such a range
  AnchorBiasConfig anchor_bias;  ///< eskf only
  RecoveryConfig recovery;
  MotionAids aids;
  double epoch_span = 0.02;          ///< s, uwb_only: ranges within it count as taken at once
  double max_speed = 12.0;           ///< m/s, uwb_only: how unsure a fix becomes while none follows
  double sigma_point_spread = 1e-3;  ///< alpha of ukf
  double lag = 0.0;                  ///< s that a measurement may come late and still be put in its place

  bool operator==(const UwbImuConfig&) const = default;
};

InertialStart validated(InertialStart config);
MotionAids validated(MotionAids config);
RecoveryConfig validated(RecoveryConfig config);
UwbImuConfig validated(UwbImuConfig config);

}  // namespace pos::estimation
