#pragma once
/// Configuration of `shearer` (Zheng et al. 2021; docs/math/shearer.md). SI units. Defaults are those of the
/// paper's tables and, where it is silent, of our specification.

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "pos/estimation/sins_configs.hpp"
#include "pos/estimation/start_config.hpp"
#include "pos/lidar/angle_calibration.hpp"

namespace pos::estimation {

/// What an alignment before the run left behind, beside the planar pose of `start`.
struct ShearerAlignment {
  double height = 0.0;           ///< m, body frame
  double pitch = 0.0;            ///< rad, nose up
  double roll = 0.0;             ///< rad, about the body's x axis
  double speed = 0.0;            ///< m/s along the body's x axis
  double tilt_sigma = 8.727e-5;  ///< rad (0.3')
  double speed_sigma = 1e-3;     ///< m/s, each axis

  bool operator==(const ShearerAlignment&) const = default;
};

/// The face and its rack as surveyed.
struct FaceConfig {
  double x = 0.0;                       ///< m, map: where the shearer stands at end 1
  double y = 0.0;                       ///< m
  double heading = 1.5707963267948966;  ///< rad in the map, from end 1 to end 2
  double length = 350.0;                ///< m, conveyor less shearer: S_max
  double advance = 1.0;                 ///< m per cycle, to the right of the heading
  double arrival_zone = 2.0;            ///< m: standing this near an end is an arrival
  double excursion_max = 60.0;          ///< m: farther from the end than this, the next pass has begun
  double standing_speed = 0.01;         ///< m/s, below which it stands, and no direction is read
  std::string roadway_sensor = "";      ///< scanner whose sweeps at the ends tell the creep; none: not told
  std::vector<double> creep = {};       ///< m along the heading in each end operation, where told by others
  double creep_sigma = 0.005;           ///< m

  bool operator==(const FaceConfig&) const = default;
};

/// The supports' legs and how the scanner sees them.
struct LegsConfig {
  std::string sensor = "lidar";                     ///< whose scans show legs
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< m, of the scanner on the body
  double spacing = 1.5;                             ///< m along the face
  double lateral = 4.0;                             ///< m, to the left of the conveyor's line
  double lateral_gate =
      1.6;  ///< m: an advance, which the S-bend of an end operation puts between the two, and 0.6
  double association_gate = 0.5;               ///< m, and from where a known leg is expected
  double diameter = 0.30;                      ///< m
  double range_sigma = 0.01;                   ///< m, of one beam; sweeps only
  lidar::ScannerCalibration calibration = {};  ///< taken out of sweeps; the default leaves them raw
  Eigen::Vector3d sigma{0.01, 0.01, 0.02};     ///< m, of a leg in scanner axes: along, across, up
  double confidence = 0.999;                   ///< of the chi-square gate
  int rejections = 5;                          ///< in a row: the leg is dropped and found anew
  double degraded_after = 20.0;                ///< s without any leg

  bool operator==(const LegsConfig&) const = default;
};

/// Which legs take part (section 5.1; modes of Table 1).
struct SelectionConfig {
  int mode = 2;            ///< 1 to 9; 0: 2 and 7 run side by side and the better at the first end 2 stays
  int features = 1;        ///< N
  double distance = 9.0;   ///< m, d: least distance along the track
  double zone_lag = 11.0;  ///< m behind the shearer's centre from which supports may have moved

  bool operator==(const SelectionConfig&) const = default;
};

/// Correction of the mount from the first cut (section 5.2).
struct PicmConfig {
  enum class Use {
    Off,
    Continue,  ///< position and all else corrected by their sensitivity to the mount; constant memory
    Restart,   ///< the first pass is kept and filtered again; about 10 kB a second of it
  } use = Use::Off;
  Eigen::Vector3d body_mount = Eigen::Vector3d::Zero();  ///< rad, rotation vector: shearer's axes in the
                                                         ///< unit's, as calibrated before

  bool operator==(const PicmConfig&) const = default;
};

/// Errors of scanner and mount as states. Sigma 0 holds one at its value.
struct ScannerStates {
  bool use = false;
  double mount_yaw_sigma = 8.727e-3;    ///< rad (0.5 deg)
  double mount_pitch_sigma = 8.727e-4;  ///< rad (3 arc minutes)
  double scale_sigma = 1e-3;            ///< -
  double offset_sigma = 0.05;           ///< m
  double angle_scale_sigma = 0.01;      ///< rad per rad off the middle of the scan
  double angle_curve_sigma = 5e-3;      ///< rad per rad^2

  bool operator==(const ScannerStates&) const = default;
};

/// What else is known of the ends (ours): a survey of where the first cut ends, and the jack strokes between
/// two visits of an end. Sigma 0: not used.
struct EndFixConfig {
  double first_cut_lateral_sigma = 0.0;  ///< m, across the face, of the first arrival at end 2
  double first_cut_along_sigma = 0.0;    ///< m, along it
  double first_cut_height_sigma = 0.0;   ///< m
  double first_cut_lateral = 0.0;        ///< m right of the line from end 1 along the heading
  double first_cut_height = 0.0;         ///< m above end 1
  double straight_sigma = 0.0;           ///< m, across the face: how far a cut strays from its line
  double straight_every = 20.0;          ///< m of way after which it strays anew
  double stroke_sigma = 0.0;             ///< m, of an advance

  bool operator==(const EndFixConfig&) const = default;
};

/// The odometer and the path estimate of the baselines.
struct ShearerOdometer {
  Eigen::Vector3d body_mount = Eigen::Vector3d::Zero();  ///< rad, rotation vector: shearer's axes in the
                                                         ///< unit's, as calibrated before
  double pitch_sigma = 3e-4;                             ///< rad, of the direction of travel (1')
  double yaw_sigma = 6e-3;                               ///< rad (20')
  double drift_sigma = 2.4e-7;                           ///< rad/s, of yaw and pitch (0.05 deg/h)
  double scale_sigma = 5e-4;                             ///< -
  double stroke_sigma = 0.02;                            ///< m, of an advance
  double height_sigma = 0.02;                            ///< m, of an end between two visits

  bool operator==(const ShearerOdometer&) const = default;
};

struct ShearerConfig {
  enum class Variant {
    Lidar,         ///< inertial unit and legs
    Dr,            ///< inertial attitude and odometer
    DrClosedPath,  ///< the same, with what returning to an end says
  } variant = Variant::Lidar;
  /// `Level`: the map's plane is level everywhere and turns with the Earth at the map's latitude.
  enum class Earth { Flat, Level } earth = Earth::Level;
  StartConfig start{StartMode::Known, {0.0, 0.0, 1.5707963267948966}, 1e-4, 1.4544e-3};  ///< 0.1 mm, 5'
  ShearerAlignment alignment;
  ImuNoise imu{2.9089e-6, 9.80665e-5, 2.4241e-7, 4.903e-4, 8.08e-11, 1e-9};
  Eigen::Vector3d imu_place = Eigen::Vector3d::Zero();  ///< m, body
  double propagation_interval = 0.04;                   ///< s between steps of the covariance
  FaceConfig face;
  LegsConfig legs;
  SelectionConfig selection;
  PicmConfig picm;
  ScannerStates scanner;
  EndFixConfig end_fix;
  ShearerOdometer odometer;

  bool operator==(const ShearerConfig&) const = default;
};

ShearerAlignment validated(ShearerAlignment config);
FaceConfig validated(FaceConfig config);
LegsConfig validated(LegsConfig config);
SelectionConfig validated(SelectionConfig config);
ScannerStates validated(ScannerStates config);
EndFixConfig validated(EndFixConfig config);
ShearerOdometer validated(ShearerOdometer config);
ShearerConfig validated(ShearerConfig config);

}  // namespace pos::estimation
