#pragma once
/// Configuration of `seamless`: satellites on the surface, radio under ground, one inertial unit. SI units;
/// defaults of sections A3, A6 and A11 of the specification (docs/math/seamless.md).

#include <Eigen/Core>
#include <vector>

#include "pos/estimation/anchor_bias_config.hpp"
#include "pos/estimation/sins_configs.hpp"
#include "pos/estimation/start_config.hpp"
#include "pos/estimation/tag_mount.hpp"
#include "pos/filters/fuzzy.hpp"
#include "pos/filters/imm.hpp"
#include "pos/filters/robust_weight.hpp"

namespace pos::estimation {

/// Where things sit on the body (m, FLU).
struct SeamlessMounts {
  Eigen::Vector3d imu = Eigen::Vector3d::Zero();
  Eigen::Vector3d gnss = Eigen::Vector3d::Zero();
  Eigen::Vector3d axle = Eigen::Vector3d::Zero();  ///< middle of the axle that does not steer
  std::vector<TagMount> tags = {};                 ///< those not listed: where the log says

  bool operator==(const SeamlessMounts&) const = default;
};

struct GnssUse {
  /// What a fix that the filter does not expect is taken for.
  enum class Surprise {
    Believe,  ///< good: the claimed covariance is the covariance (the paper)
    Gate,     ///< wrong: it is left out
    Adapt,    ///< worse than it claims: so are the next, until `adapt_time` has passed without a surprise
  } surprise = Surprise::Adapt;
  /// Under ground, as the map's portals tell, satellites are left out.
  enum class Mask {
    Automatic,
    Off,     ///< never left out
    Always,  ///< left out everywhere, the operator's word
  } mask = Mask::Automatic;
  double confidence = 0.999;  ///< a fix further off than this share of honest ones is a surprise
  double adapt_time = 1.0;    ///< s
  double sigma_max = 20.0;    ///< m, per horizontal axis: a fix that claims to be worse is left out
  double mask_margin = 1.0;   ///< m beyond the hand-over zone before it is dark (besides three sigma)

  bool operator==(const GnssUse&) const = default;
};

struct UwbUse {
  double sigma = 0.10;           ///< m, of a range in sight
  filters::RobustConfig robust;  ///< how doubtful ranges count
  /// Learns how much worse than `sigma` the ranges are, over about so many of them that are shorter than
  /// expected (those too long may be of hidden anchors); 0: does not.
  double adapt_count = 0.0;
  AnchorBiasConfig anchor_bias;  ///< offsets of anchors that keep surprising
  bool masked = false;           ///< left out everywhere, the operator's word

  bool operator==(const UwbUse&) const = default;
};

/// How the two filters interact.
struct InteractionConfig {
  double stay = 0.95;          ///< probability that the mode is the same one `period` later
  double period = 0.02;        ///< s
  double first_gnss = 0.98;    ///< probability of the satellites' mode at the start
  double floor = 1e-3;         ///< no probability falls below
  double usable_floor = 1e-3;  ///< nor that of a mode in use below this
  filters::LikelihoodForm likelihood = filters::LikelihoodForm::Normalised;
  double overdue = 0.005;         ///< s after a reading was due, the mode is silent
  int rejected_in_a_row = 3;      ///< so many epochs of nothing but rejected readings: not usable either
  double recover_after = 2.0;     ///< s without a usable mode: the state is made uncertain again
  double rejoin_inflation = 2.0;  ///< of the combined covariance, for a mode that comes back

  bool operator==(const InteractionConfig&) const = default;
};

/// What else is known of the vehicle and the mine; all off, as in the paper.
struct SeamlessAids {
  double side_slip_sigma = 0.0;  ///< m/s, sideways and upward speed of the axle; 0: not used
  double floor_sigma = 0.0;      ///< m, height of the body over the map's floor; 0: not used
  double interval = 0.1;         ///< s between them

  bool operator==(const SeamlessAids&) const = default;
};

struct SeamlessConfig {
  enum class Variant {
    Imm,    ///< Bayes' rule
    Faimm,  ///< and the fuzzy controller
  } variant = Variant::Faimm;
  StartConfig start{StartMode::Known, {}, 0.1, 0.035};
  double height = 0.0;  ///< m, of the body frame at the start
  double height_sigma = 0.1;
  double velocity_sigma = 0.1;  ///< m/s at the start
  ImuNoise imu{.gyro_density = 2e-4,
               .accelerometer_density = 2e-3,
               .gyro_bias_sigma = 5e-4,
               .accelerometer_bias_sigma = 0.02,
               .gyro_bias_walk = 1e-6,
               .accelerometer_bias_walk = 1e-4};
  AlignmentConfig alignment{2.0, 0.0175, 0.05, true};
  ins::StandstillConfig standstill;
  SeamlessMounts mounts;
  GnssUse gnss;
  UwbUse uwb;
  InteractionConfig imm;
  filters::FuzzyConfig fuzzy;
  SeamlessAids aids;

  bool operator==(const SeamlessConfig&) const = default;
};

GnssUse validated(GnssUse config);
UwbUse validated(UwbUse config);
InteractionConfig validated(InteractionConfig config);
SeamlessAids validated(SeamlessAids config);
SeamlessConfig validated(SeamlessConfig config);

}  // namespace pos::estimation
