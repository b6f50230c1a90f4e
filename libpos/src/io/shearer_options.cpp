#include "pos/io/shearer_options.hpp"

#include "pos/io/estimator_options.hpp"
#include "pos/io/sins_options.hpp"

namespace pos::io {
namespace {

using estimation::EndFixConfig;
using estimation::FaceConfig;
using estimation::LegsConfig;
using estimation::PicmConfig;
using estimation::ScannerStates;
using estimation::SelectionConfig;
using estimation::ShearerAlignment;
using estimation::ShearerConfig;
using estimation::ShearerOdometer;

constexpr auto kValid = [](const auto& config) { return validated(config); };

OptionTable<ShearerAlignment> shearerAlignmentOptions() {
  return OptionTable<ShearerAlignment>("alignment", "What an alignment before the run left behind.")
      .number("height_m", &ShearerAlignment::height, between(-10000, 10000), "Of the body frame.")
      .number("pitch_deg", &ShearerAlignment::pitch, between(-45, 45), "Nose up.")
      .number("roll_deg", &ShearerAlignment::roll, between(-45, 45), "About the body's x axis.")
      .number("speed_m_per_s", &ShearerAlignment::speed, between(-10, 10), "Along the body's x axis.")
      .number("tilt_sigma_deg", &ShearerAlignment::tilt_sigma, moreThan(0), "How sure pitch and roll are.")
      .number("speed_sigma_m_per_s", &ShearerAlignment::speed_sigma, moreThan(0), "How sure the velocity is.")
      .check(kValid);
}

OptionTable<FaceConfig> faceOptions() {
  return OptionTable<FaceConfig>("face", "The face and its rack as surveyed.")
      .number("x_m", &FaceConfig::x, between(-100000, 100000), "Where the shearer stands at end 1.")
      .number("y_m", &FaceConfig::y, between(-100000, 100000), "The same.")
      .number("heading_deg", &FaceConfig::heading, between(-360, 360),
              "From end 1 to end 2, counter-clockwise from the map's x axis.")
      .number("length_m", &FaceConfig::length, moreThan(0), "Length of the conveyor less the shearer's.")
      .number("advance_m", &FaceConfig::advance, between(0, 10), "Per cycle, to the right of the heading.")
      .number("arrival_zone_m", &FaceConfig::arrival_zone, moreThan(0),
              "Standing this near an end is an arrival.")
      .number("excursion_max_m", &FaceConfig::excursion_max, moreThan(0),
              "Farther from the end than this, the next pass has begun.")
      .number("standing_speed_m_per_s", &FaceConfig::standing_speed, moreThan(0),
              "Below this it stands, and no direction is read.")
      .text("roadway_sensor", &FaceConfig::roadway_sensor,
            "Scanner whose sweeps at the ends tell the creep; empty: not told.")
      .numbers("creep_m", &FaceConfig::creep, between(-5, 5),
               "Along the heading in each end operation, where it is told by others.")
      .number("creep_sigma_m", &FaceConfig::creep_sigma, moreThan(0), "How sure that is.")
      .check(kValid);
}

OptionTable<lidar::ScannerCalibration> calibrationOptions() {
  using Calibration = lidar::ScannerCalibration;
  return OptionTable<Calibration>("calibration", "Errors of the scanner to be taken out of its sweeps.")
      .number("a1", &Calibration::a1, anything(), "True angle = a1 m^2 + a2 m + a3 of a measured m, in deg.")
      .number("a2", &Calibration::a2, anything(), "The same.")
      .number("a3", &Calibration::a3, anything(), "The same.")
      .number("scale", &Calibration::scale, between(-0.5, 0.5), "Measured range = (1 + scale) true + offset.")
      .number("offset_m", &Calibration::offset, between(-10, 10), "The same.")
      .check(kValid);
}

OptionTable<LegsConfig> legsOptions() {
  return OptionTable<LegsConfig>("legs", "The supports' legs and how the scanner sees them.")
      .text("sensor", &LegsConfig::sensor, "Label of the scanner.")
      .numbers("place_m", &LegsConfig::place, between(-100, 100), "Of the scanner on the body.")
      .number("spacing_m", &LegsConfig::spacing, moreThan(0), "From support to support.")
      .number("lateral_m", &LegsConfig::lateral, moreThan(0), "Legs stand this far left of the conveyor.")
      .number("lateral_gate_m", &LegsConfig::lateral_gate, moreThan(0),
              "What is further from that is no leg; an advance and what the bend takes.")
      .number("association_gate_m", &LegsConfig::association_gate, moreThan(0),
              "A leg further from where one is expected is another one.")
      .number("diameter_m", &LegsConfig::diameter, moreThan(0), "Of a leg.")
      .number("range_sigma_m", &LegsConfig::range_sigma, moreThan(0), "Of one beam of a sweep.")
      .table("calibration", &LegsConfig::calibration, calibrationOptions(),
             "Errors of the scanner, known; without it sweeps are taken as they are.")
      .numbers("sigma_m", &LegsConfig::sigma, moreThan(0),
               "Of a leg in scanner axes: along, across, up. For sweeps the first two come from the fit.")
      .number("confidence", &LegsConfig::confidence, between(0.5, 0.999999),
              "A leg further off than this share of honest ones is rejected.")
      .integer("rejections", &LegsConfig::rejections, between(1, 1000),
               "So many in a row, and the leg is dropped and found anew.")
      .number("degraded_after_s", &LegsConfig::degraded_after, moreThan(0),
              "Without any leg for so long the position counts as degraded.")
      .check(kValid);
}

OptionTable<SelectionConfig> selectionOptions() {
  return OptionTable<SelectionConfig>("selection", "Which legs take part.")
      .integer("mode", &SelectionConfig::mode, between(0, 9),
               "Table 1 of the paper; 0 runs 2 and 7 side by side until the first end 2.")
      .integer("features", &SelectionConfig::features, between(1, 8), "How many at a time (N).")
      .number("distance_m", &SelectionConfig::distance, between(0, 100),
              "Least distance along the track (d).")
      .number("zone_lag_m", &SelectionConfig::zone_lag, moreThan(0),
              "Supports this far behind the shearer's centre may have moved.")
      .check(kValid);
}

OptionTable<PicmConfig> picmOptions() {
  using Use = PicmConfig::Use;
  return OptionTable<PicmConfig>("picm", "Correction of the scanner's mount at the first end 2.")
      .choice("use", &PicmConfig::use,
              {{"off", Use::Off}, {"continue", Use::Continue}, {"restart", Use::Restart}},
              "Not at all; correct the state by its sensitivity; filter the first pass again.")
      .numbers("body_mount_deg", &PicmConfig::body_mount, between(-10, 10),
               "Rotation vector: the shearer's axes in the inertial unit's, as calibrated before.");
}

OptionTable<ScannerStates> scannerStateOptions() {
  return OptionTable<ScannerStates>("scanner", "Errors of scanner and mount as states.")
      .flag("states", &ScannerStates::use, "Whether they are estimated.")
      .number("mount_yaw_sigma_deg", &ScannerStates::mount_yaw_sigma, between(0, 10), "Yaw of the mount.")
      .number("mount_pitch_sigma_deg", &ScannerStates::mount_pitch_sigma, between(0, 10),
              "Pitch of the mount.")
      .number("scale_sigma", &ScannerStates::scale_sigma, between(0, 0.1), "Scale of ranges.")
      .number("offset_sigma_m", &ScannerStates::offset_sigma, between(0, 1), "Offset of ranges.")
      .number("angle_scale_sigma", &ScannerStates::angle_scale_sigma, between(0, 0.1), "Scale of angles.")
      .number("angle_curve_sigma", &ScannerStates::angle_curve_sigma, between(0, 0.1),
              "Their curvature, rad per rad squared.")
      .check(kValid);
}

OptionTable<EndFixConfig> endFixOptions() {
  return OptionTable<EndFixConfig>("end_fix", "What a survey and the jacks say of the ends; 0: not used.")
      .number("first_cut_lateral_sigma_m", &EndFixConfig::first_cut_lateral_sigma, between(0, 10),
              "Survey of where the first cut ends, across the face.")
      .number("first_cut_along_sigma_m", &EndFixConfig::first_cut_along_sigma, between(0, 10),
              "The same along it: the rack's length.")
      .number("first_cut_height_sigma_m", &EndFixConfig::first_cut_height_sigma, between(0, 10),
              "The same of its height.")
      .number("first_cut_lateral_m", &EndFixConfig::first_cut_lateral, between(-100, 100),
              "Right of the line from end 1 along the heading.")
      .number("first_cut_height_m", &EndFixConfig::first_cut_height, between(-100, 100), "Above end 1.")
      .number("straight_sigma_m", &EndFixConfig::straight_sigma, between(0, 10),
              "How far a cut strays from its line, across the face; the line moves by the advances.")
      .number("straight_every_m", &EndFixConfig::straight_every, moreThan(0),
              "Way after which it strays anew.")
      .number("stroke_sigma_m", &EndFixConfig::stroke_sigma, between(0, 10),
              "Of an advance, between two arrivals at an end.")
      .check(kValid);
}

OptionTable<ShearerOdometer> shearerOdometerOptions() {
  return OptionTable<ShearerOdometer>("odometer", "Dead reckoning: the direction of travel and its errors.")
      .numbers("body_mount_deg", &ShearerOdometer::body_mount, between(-10, 10),
               "Rotation vector: the shearer's axes in the inertial unit's, as calibrated before.")
      .number("pitch_sigma_deg", &ShearerOdometer::pitch_sigma, moreThan(0), "How sure the climb is.")
      .number("yaw_sigma_deg", &ShearerOdometer::yaw_sigma, moreThan(0), "How sure the course is.")
      .number("drift_sigma_deg_per_s", &ShearerOdometer::drift_sigma, moreThan(0), "How both drift.")
      .number("scale_sigma", &ShearerOdometer::scale_sigma, moreThan(0), "How sure the odometer's scale is.")
      .number("stroke_sigma_m", &ShearerOdometer::stroke_sigma, moreThan(0), "Of an advance.")
      .number("height_sigma_m", &ShearerOdometer::height_sigma, moreThan(0),
              "How much the height of an end differs between two visits.")
      .check(kValid);
}

}  // namespace

OptionTable<ShearerConfig> shearerOptions() {
  using Config = ShearerConfig;
  return OptionTable<Config>("shearer", "A longwall shearer among the legs of the supports.")
      .choice("variant", &Config::variant,
              {{"lidar", Config::Variant::Lidar},
               {"dr", Config::Variant::Dr},
               {"dr_closed_path", Config::Variant::DrClosedPath}},
              "Inertial unit and legs; or dead reckoning, alone or with what returning to an end says.")
      .choice("earth", &Config::earth, {{"flat", Config::Earth::Flat}, {"level", Config::Earth::Level}},
              "Still, or turning at the latitude of the map's origin.")
      .table("start", &Config::start, startOptions(), "Position and heading at the first measurement.")
      .table("alignment", &Config::alignment, shearerAlignmentOptions(), "What an alignment left behind.")
      .table("imu", &Config::imu, imuNoiseOptions(), "What the inertial unit does wrong.")
      .numbers("imu_place_m", &Config::imu_place, between(-100, 100), "Of the inertial unit on the body.")
      .number("propagation_interval_s", &Config::propagation_interval, between(0.001, 1),
              "Time between steps of the covariance.")
      .table("face", &Config::face, faceOptions(), "The face and its rack.")
      .table("legs", &Config::legs, legsOptions(), "The supports' legs.")
      .table("selection", &Config::selection, selectionOptions(), "Which legs take part.")
      .table("picm", &Config::picm, picmOptions(), "Correction of the mount at the first end 2.")
      .table("scanner", &Config::scanner, scannerStateOptions(), "Errors of scanner and mount as states.")
      .table("end_fix", &Config::end_fix, endFixOptions(), "What a survey and the jacks say of the ends.")
      .table("odometer", &Config::odometer, shearerOdometerOptions(), "Dead reckoning's own.")
      .check(kValid);
}

}  // namespace pos::io
