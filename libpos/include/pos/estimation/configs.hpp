#pragma once
/// The configuration of every estimator: plain structs, SI units, defaults beside each field. io binds them
/// to YAML.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pos/core/belief.hpp"
#include "pos/core/measurement.hpp"
#include "pos/core/pose2.hpp"
#include "pos/estimation/calibration_state.hpp"
#include "pos/estimation/seamless_configs.hpp"
#include "pos/estimation/shearer_configs.hpp"
#include "pos/estimation/sins_configs.hpp"
#include "pos/estimation/start_config.hpp"
#include "pos/estimation/tag_mount.hpp"
#include "pos/estimation/uwb_imu_config.hpp"

namespace pos::estimation {

/// Planar odometry noise, grown with the motion (a density per metre turned) and with time.
struct OdometryNoise {
  double distance_per_sqrt_m = 0.03;   ///< m / sqrt(m): along track, random walk over distance
  double lateral_per_sqrt_m = 0.01;    ///< m / sqrt(m): across track
  double yaw_per_sqrt_m = 0.01;        ///< rad / sqrt(m)
  double yaw_per_sqrt_rad = 0.03;      ///< rad / sqrt(rad turned)
  double yaw_per_sqrt_s = 0.0005;      ///< rad / sqrt(s)
  double position_per_sqrt_s = 0.001;  ///< m / sqrt(s)

  bool operator==(const OdometryNoise&) const = default;
};

struct DeadReckoningConfig {
  enum class Variant {
    Odometry,          ///< increments as they come
    Encoders,          ///< two wheels: way and turn
    EncodersAttitude,  ///< way from the wheels, attitude from the gyros
    EkfHeading,        ///< both headings in a filter
  } variant = Variant::Odometry;
  StartConfig start;
  OdometryNoise noise;  ///< of the variant `odometry`; the others have what follows
  double height = 0.0;  ///< m, of the body frame in the map at the start
  EarthModel earth = EarthModel::Flat;
  ImuNoise imu;
  InertialMounts mounts;
  AlignmentConfig alignment;
  ins::StandstillConfig standstill;
  ins::OdometerConfig odometer;
  CalibrationState wheel_scale{0.0, 0.0, 0.0};  ///< wheels read (1 + it) times the way
  HeadingFilterConfig heading;

  bool operator==(const DeadReckoningConfig&) const = default;
};

/// How a gate opens again when it keeps rejecting what may well be true.
struct GateConfig {
  double confidence = 0.997;  ///< a range beyond this chi-square quantile is gated
  double open_after = 5.0;    ///< s without any agreement before the gate opens and the state is inflated
  double agreement_fraction =
      0.34;                ///< agreement = at least this fraction of the anchors heard in that time pass
  double inflation = 4.0;  ///< factor on the pose covariance each time the gate opens

  bool operator==(const GateConfig&) const = default;
};

struct RangeOdometryConfig {
  enum class Motion {
    Odometry,          ///< driven by odometry increments
    ConstantVelocity,  ///< no odometry: velocity and yaw rate are states
  } motion = Motion::Odometry;
  StartConfig start;
  OdometryNoise odometry_noise;
  double acceleration_density = 0.5;      ///< m/s^2 * sqrt(s), constant-velocity motion
  double yaw_acceleration_density = 0.3;  ///< rad/s^2 * sqrt(s), constant-velocity motion
  double max_speed = 15.0;                ///< m/s, sets the prior of the velocity states
  std::vector<TagMount> tags;             ///< before what the log says of the tag's place
  double body_height = 0.0;               ///< m, z of the body frame in the map
  double range_sigma = 0.1;               ///< m
  CalibrationState range_scale{1.0, 0.0, 0.0};
  CalibrationState range_offset{0.0, 0.0, 0.0};   ///< m
  CalibrationState anchor_offset{0.0, 0.0, 0.0};  ///< m, one state per anchor
  CalibrationState gyro_bias{0.0, 0.0, 0.0};      ///< rad/s
  CalibrationState wheel_scale{1.0, 0.0, 0.0};
  CalibrationState latency{0.0, 0.0, 0.0};  ///< s, the ranges tell of this long ago
  GateConfig gate;
  int heading_hypotheses = 12;  ///< filters started when the heading is unknown

  bool operator==(const RangeOdometryConfig&) const = default;
};

struct RangeLikelihood {
  double sigma = 0.2;                ///< m, of a good range
  double outlier_probability = 0.1;  ///< share of ranges that say nothing about the distance
  double range_max = 100.0;          ///< m, an outlier lies uniformly in [0, range_max]
  double bias_sigma = 0.0;  ///< m, slowly varying offset per anchor, tracked beside the particles; 0 = none
  double bias_time = 30.0;  ///< s, correlation time of that offset
  /// m: ranges to one anchor taken within this distance share their error (survey, antenna, reflections) and
  /// count as one. 0 = every range counts in full.
  double correlation_length = 2.5;

  bool operator==(const RangeLikelihood&) const = default;
};

struct ScanLikelihood {
  int beams = 60;      ///< beams used, spread evenly over the scan
  double sigma = 0.1;  ///< m, of the distance to the nearest obstacle
  double outlier_probability = 0.2;
  double distance_max = 1.0;  ///< m, distances saturate here
  double tempering = 1.0;     ///< further exponent on the scan's likelihood
  /// m: beams that end within this distance of each other, and scans taken within it, share their error (the
  /// map's, mostly) and count as one. 0 = every beam of every scan counts in full.
  double correlation_length = 0.5;

  bool operator==(const ScanLikelihood&) const = default;
};

struct ParticleCount {
  int min = 500;
  int max = 20000;
  double kld_epsilon = 0.02;   ///< Fox 2003: bound on the KL divergence
  double kld_z = 2.33;         ///< normal quantile of the confidence, 2.33 = 99 %
  double bin_position = 0.25;  ///< m
  double bin_yaw = 0.1745;     ///< rad

  bool operator==(const ParticleCount&) const = default;
};

struct MclConfig {
  StartConfig start;
  OdometryNoise odometry_noise;
  std::vector<TagMount> tags;
  double body_height = 0.0;  ///< m
  bool use_ranges = true;
  bool use_scans = false;
  RangeLikelihood range;
  ScanLikelihood scan;
  ParticleCount particles;
  double resample_below = 0.5;  ///< resample when the effective size falls below this share
  double injection_slow =
      0.001;  ///< augmented MCL decay rates (Thrun, Burgard, Fox 2005, table 8.3); 0 = none
  double injection_fast = 0.1;
  std::uint64_t seed = 1;

  bool operator==(const MclConfig&) const = default;
};

/// MRPT's own particle filter with the same inputs.
struct MrptMclConfig {
  StartConfig start;
  OdometryNoise odometry_noise;
  std::vector<TagMount> tags;
  double body_height = 0.0;  ///< m
  bool use_ranges = true;
  bool use_scans = false;
  double range_sigma = 0.17;  ///< m, MRPT's rangeStd
  int particles = 2000;
  bool adaptive_size = true;  ///< KLD
  int beams = 60;
  std::uint64_t seed = 1;

  bool operator==(const MrptMclConfig&) const = default;
};

/// What the links read too long beside the biases that are taken off, as one state for each link. Sigma 0: no
/// such states.
struct LinkBiasState {
  double value = 0.0;            ///< m, at the start
  double sigma = 0.0;            ///< m, how sure the value is at the start
  double walk_per_sqrt_s = 0.0;  ///< m / sqrt(s), a bias that wanders without bound
  /// s, a bias that changes with the side an anchor is seen from: it keeps its sigma, and forgets itself over
  /// this time (a Gauss-Markov process about the value). 0 = it does not.
  double time = 0.0;

  bool operator==(const LinkBiasState&) const = default;
};

/// What one link, a tag and an anchor, reads too long (m). Written by `pos calibrate ranges`.
struct LinkBias {
  TagId tag = 0;
  AnchorId anchor = 0;
  double bias = 0.0;

  bool operator==(const LinkBias&) const = default;
};

/// How far a tag's electrical place lies from its mount, m, body axes. Written by `pos calibrate ranges`.
struct TagShift {
  TagId id = 0;
  double x = 0.0;
  double y = 0.0;

  bool operator==(const TagShift&) const = default;
};

/// Which ranges a filter believes, when it thinks an anchor hidden, and when it thinks itself lost.
struct SightConfig {
  double confidence = 0.999;         ///< a range beyond this chi-square quantile is gated
  int blocked_after = 3;             ///< rejections of one anchor in a row that mark it as hidden
  double blocked_for = 1.0;          ///< s it stays marked
  double restart_after = 1.0;        ///< s without agreement after which the filter starts over
  double agreement_fraction = 0.34;  ///< agreement = at least this share of the anchors heard pass

  bool operator==(const SightConfig&) const = default;
};

/// A vehicle with two or more tags (docs/math/dual_uwb.md).
struct DualUwbConfig {
  enum class Variant {
    Snapshot,      ///< per epoch: both tags located, heading from the line between them
    Differential,  ///< the same, summed up from epoch to epoch
    Rigid,         ///< per epoch: one pose from all ranges of all tags
    Filter,        ///< Kalman filter on raw ranges, each at its own stamp
    FilterGyro,    ///< the same, turned by a gyro
  } variant = Variant::Filter;
  enum class Motion {
    Vehicle,  ///< drives where its wheels point: no velocity sideways but that of turning
    Free,     ///< may slide: the velocity has two components
  } motion = Motion::Vehicle;
  StartConfig start{StartMode::Unknown, {}, 0.1, 0.05};
  double still_at_start = 0.0;            ///< s that the vehicle is known to stand after the first fix
  std::vector<TagMount> tags;             ///< the tags used; none: all, where the log says they sit
  double body_height = 0.0;               ///< m, z of the body frame in the map
  double range_sigma = 0.05;              ///< m
  double range_offset = 0.0;              ///< m, subtracted from every range
  LinkBiasState link_bias;                ///< filters only
  std::string range_bias_table;           ///< file that holds range_biases and tag_shifts
  std::vector<LinkBias> range_biases;     ///< subtracted from the ranges of one link
  std::vector<TagShift> tag_shifts;       ///< added to the places of tags
  double epoch_span = 0.04;               ///< s, ranges within it count as taken at once (not the filters)
  double acceleration_density = 0.5;      ///< m/s^2 * sqrt(s)
  double yaw_acceleration_density = 0.2;  ///< rad/s^2 * sqrt(s)
  double max_speed = 3.0;                 ///< m/s, sets the priors of the velocity
  double max_yaw_rate = 0.6;              ///< rad/s, sets the prior of the yaw rate
  double motion_centre_x = 0.0;           ///< m, the body frame lies this far ahead of where it turns about
  double course_offset = 0.0;             ///< rad, the straight course lies this far left of the body's x
  double lateral_sigma = 0.0;      ///< m/s, how well a free vehicle keeps to its wheels; 0 = not at all
  double wheel_speed_sigma = 0.0;  ///< m/s; 0 = wheel speeds are not used
  double gyro_noise = 0.002;       ///< rad / sqrt(s), angle random walk
  CalibrationState gyro_bias{0, 0.01, 1e-4};  ///< rad/s
  bool never_reverses = false;                ///< a pose that drives backwards is wrong
  SightConfig gate;
  double fit_significance = 0.001;       ///< share of good fits that are searched for bad ranges all the same
  std::vector<Eigen::Vector2d> roadway;  ///< corners of the ground the vehicle can be on, m; none: anywhere

  bool operator==(const DualUwbConfig&) const = default;
};

/// The struct itself when an estimator can be built from it. Throws ConfigError with the key as it is spelt
/// in configuration files, relative to the struct: signs, and the rules that join several keys.
StartConfig validated(StartConfig config);
OdometryNoise validated(OdometryNoise config);
GateConfig validated(GateConfig config);
DeadReckoningConfig validated(DeadReckoningConfig config);
RangeOdometryConfig validated(RangeOdometryConfig config);
RangeLikelihood validated(RangeLikelihood config);
ScanLikelihood validated(ScanLikelihood config);
ParticleCount validated(ParticleCount config);
MclConfig validated(MclConfig config);
MrptMclConfig validated(MrptMclConfig config);
SightConfig validated(SightConfig config);
DualUwbConfig validated(DualUwbConfig config);

using EstimatorConfig =
    std::variant<DeadReckoningConfig, RangeOdometryConfig, MclConfig, MrptMclConfig, DualUwbConfig,
                 SinsDrConfig, UwbImuConfig, SeamlessConfig, ShearerConfig>;
EstimatorConfig validated(EstimatorConfig config);

}  // namespace pos::estimation
