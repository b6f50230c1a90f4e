#include "pos/io/estimator_options.hpp"

#include "pos/io/seamless_options.hpp"
#include "pos/io/shearer_options.hpp"
#include "pos/io/sins_options.hpp"
#include "pos/io/uwb_imu_options.hpp"

#include <array>

namespace pos::io {
namespace {

using estimation::CalibrationState;
using estimation::GateConfig;
using estimation::MclConfig;
using estimation::MrptMclConfig;
using estimation::OdometryNoise;
using estimation::ParticleCount;
using estimation::RangeLikelihood;
using estimation::RangeOdometryConfig;
using estimation::ScanLikelihood;
using estimation::StartConfig;
using estimation::StartMode;
using estimation::TagMount;

constexpr auto kValid = [](const auto& config) { return validated(config); };

OptionTable<GateConfig> gateOptions() {
  return OptionTable<GateConfig>("gate",
                                 "Which ranges are rejected, and when the filter doubts itself instead.")
      .number("confidence", &GateConfig::confidence, between(0.5, 0.999999),
              "A range further off than this share of good ranges would be is rejected.")
      .number("open_after_s", &GateConfig::open_after, between(0.1, 3600),
              "After this long without agreement the state is made uncertain again.")
      .number("agreement_fraction", &GateConfig::agreement_fraction, between(0, 1),
              "Agreement means that at least this share of the anchors heard pass the gate.")
      .number("inflation", &GateConfig::inflation, between(1, 10000),
              "Factor on the pose covariance each time the gate opens.")
      .check(kValid);
}

OptionTable<RangeLikelihood> rangeLikelihoodOptions() {
  return OptionTable<RangeLikelihood>("range", "How a particle is weighed by a range.")
      .number("sigma_m", &RangeLikelihood::sigma, between(0.001, 100), "Standard deviation of a good range.")
      .number("outlier_probability", &RangeLikelihood::outlier_probability, between(0, 1),
              "Share of ranges that say nothing about the distance.")
      .number("range_max_m", &RangeLikelihood::range_max, between(0.1, 100000),
              "Longest range; an outlier lies anywhere below it.")
      .number("bias_sigma_m", &RangeLikelihood::bias_sigma, between(0, 100),
              "Slowly varying offset of each anchor, tracked beside the particles; 0 means none.")
      .number("bias_time_s", &RangeLikelihood::bias_time, moreThan(0), "Correlation time of that offset.")
      .number("correlation_length_m", &RangeLikelihood::correlation_length, between(0, 1000),
              "Ranges to one anchor taken within this way share their error and count as one; 0 counts all.")
      .check(kValid);
}

OptionTable<ScanLikelihood> scanLikelihoodOptions() {
  return OptionTable<ScanLikelihood>("scan", "How a particle is weighed by a laser scan.")
      .integer("beams", &ScanLikelihood::beams, between(1, 100000),
               "Beams used, spread evenly over the scan.")
      .number("sigma_m", &ScanLikelihood::sigma, between(0.001, 100),
              "Standard deviation of the distance to the nearest wall.")
      .number("outlier_probability", &ScanLikelihood::outlier_probability, between(0, 1),
              "Share of beams that hit something not on the map.")
      .number("distance_max_m", &ScanLikelihood::distance_max, between(0.01, 1000),
              "Distances to the nearest wall count as this at most.")
      .number("tempering", &ScanLikelihood::tempering, between(0.0001, 1),
              "Further exponent on the scan's likelihood.")
      .number("correlation_length_m", &ScanLikelihood::correlation_length, between(0, 1000),
              "Beams ending, and scans taken, this near each other share their error and count as one; 0 "
              "counts all.")
      .check(kValid);
}

OptionTable<ParticleCount> particleOptions() {
  return OptionTable<ParticleCount>("particles", "How many particles are kept (KLD sampling, Fox 2003).")
      .integer("min", &ParticleCount::min, between(1, 10000000), "Smallest number of particles.")
      .integer("max", &ParticleCount::max, between(1, 10000000), "Largest number of particles.")
      .number("kld_epsilon", &ParticleCount::kld_epsilon, between(0.0001, 1),
              "Bound on the error of the particle cloud; smaller keeps more particles.")
      .number("kld_z", &ParticleCount::kld_z, between(0.1, 10),
              "Normal quantile of the confidence in that bound; 2.33 is 99 percent.")
      .number("bin_position_m", &ParticleCount::bin_position, between(0.001, 1000),
              "Width of a cell in x and y.")
      .number("bin_yaw_deg", &ParticleCount::bin_yaw, between(0.01, 360), "Width of a cell in heading.")
      .check(kValid);
}

}  // namespace

OptionTable<TagMount> tagOptions() {
  return OptionTable<TagMount>("tag", "Where a radio tag sits on the vehicle.")
      .integer("id", &TagMount::id, anything(), "The radio's own number of the tag.")
      .required()
      .number(
          "x_m", [](auto& tag) -> auto& { return tag.p_body.x(); }, between(-100, 100),
          "Forward of the body frame.")
      .required()
      .number(
          "y_m", [](auto& tag) -> auto& { return tag.p_body.y(); }, between(-100, 100),
          "Left of the body frame.")
      .required()
      .number(
          "z_m", [](auto& tag) -> auto& { return tag.p_body.z(); }, between(-100, 100),
          "Above the body frame.");
}

OptionTable<CalibrationState> calibrationOptions(const std::string& title, const std::string& unit,
                                                 Range value, double sigma_max) {
  const std::string of_unit = unit.empty() ? "" : "_" + unit;
  return OptionTable<CalibrationState>(title, "A slowly changing unknown of a sensor.")
      .number("value" + of_unit, &CalibrationState::value, value, "Value at the start.")
      .number("sigma" + of_unit, &CalibrationState::sigma, between(0, sigma_max),
              "How sure the value is at the start; 0 holds it fixed.")
      .number("walk" + of_unit + "_per_sqrt_s", &CalibrationState::walk_per_sqrt_s, between(0, sigma_max),
              "How fast it wanders (random walk).");
}

OptionTable<StartConfig> startOptions() {
  return OptionTable<StartConfig>("start", "What is known of the pose at the first measurement.")
      .choice(
          "mode", &StartConfig::mode,
          {{"known", StartMode::Known},
           {"unknown_heading", StartMode::UnknownHeading},
           {"unknown", StartMode::Unknown},
           {"at_truth", StartMode::AtTruth}},
          "Whether position and heading, the position alone, or nothing is known; at_truth takes the first "
          "reference pose as the surveyed mark of the start (its heading only where the reference has one).")
      .number(
          "x_m", [](auto& start) -> auto& { return start.pose.x; }, anything(), "East in the map.")
      .number(
          "y_m", [](auto& start) -> auto& { return start.pose.y; }, anything(), "North in the map.")
      .number(
          "yaw_deg", [](auto& start) -> auto& { return start.pose.yaw; }, between(-360, 360),
          "Heading, counter-clockwise from the map's x axis.")
      .number("position_sigma_m", &StartConfig::position_sigma, between(0.0001, 100000),
              "How sure the position is, standard deviation of each axis.")
      .number("yaw_sigma_deg", &StartConfig::yaw_sigma, between(0.0001, 360),
              "How sure the heading is, standard deviation.")
      .check(kValid);
}

OptionTable<OdometryNoise> odometryNoiseOptions() {
  return OptionTable<OdometryNoise>("odometry_noise", "How odometry errors grow with way, turning and time.")
      .number("distance_m_per_sqrt_m", &OdometryNoise::distance_per_sqrt_m, between(0, 10),
              "Along the track, growing with the way driven.")
      .number("lateral_m_per_sqrt_m", &OdometryNoise::lateral_per_sqrt_m, between(0, 10),
              "Across the track, growing with the way driven.")
      .number("yaw_deg_per_sqrt_m", &OdometryNoise::yaw_per_sqrt_m, between(0, 90),
              "Heading, growing with the way driven.")
      .number("yaw_deg_per_sqrt_deg", &OdometryNoise::yaw_per_sqrt_rad, between(0, 90),
              "Heading, growing with the angle turned.")
      .number("yaw_deg_per_sqrt_s", &OdometryNoise::yaw_per_sqrt_s, between(0, 90),
              "Heading, growing with time.")
      .number("position_m_per_sqrt_s", &OdometryNoise::position_per_sqrt_s, between(0, 10),
              "Position, growing with time.")
      .check(kValid);
}

OptionTable<RangeOdometryConfig> rangeOdometryOptions() {
  using Config = RangeOdometryConfig;
  return OptionTable<Config>("range_odometry", "Planar Kalman filter on odometry and radio ranges.")
      .choice(
          "motion", &Config::motion,
          {{"odometry", Config::Motion::Odometry}, {"constant_velocity", Config::Motion::ConstantVelocity}},
          "Driven by odometry, or without it by assuming a nearly constant velocity.")
      .table("start", &Config::start, startOptions(), "What is known of the pose at the first measurement.")
      .table("odometry_noise", &Config::odometry_noise, odometryNoiseOptions(),
             "How odometry errors grow with way, turning and time.")
      .number("acceleration_density_m_per_s_per_sqrt_s", &Config::acceleration_density, between(0.0001, 1000),
              "How fast the speed wanders, for constant_velocity.")
      .number("yaw_acceleration_density_deg_per_s_per_sqrt_s", &Config::yaw_acceleration_density,
              between(0.0001, 10000), "How fast the yaw rate wanders, for constant_velocity.")
      .number("max_speed_m_per_s", &Config::max_speed, between(0.01, 100),
              "Fastest speed of the vehicle; sets how unsure the speed is at the start.")
      .list("tags", &Config::tags, tagOptions(), "Where the tags sit; goes before what the log says of it.")
      .number("body_height_m", &Config::body_height, between(-10000, 10000),
              "Height of the body frame in the map.")
      .number("range_sigma_m", &Config::range_sigma, between(0.001, 100), "Standard deviation of a range.")
      .table("range_scale", &Config::range_scale, calibrationOptions("range_scale", "", between(0.5, 2), 0.5),
             "Factor between measured and true ranges.")
      .table("range_offset", &Config::range_offset,
             calibrationOptions("range_offset", "m", between(-100, 100), 100), "Added to all true ranges.")
      .table("anchor_offset", &Config::anchor_offset,
             calibrationOptions("anchor_offset", "m", between(-100, 100), 100),
             "Added to the true ranges of one anchor; every anchor has its own.")
      .table("gyro_bias", &Config::gyro_bias,
             calibrationOptions("gyro_bias", "deg_per_s", between(-100, 100), 100),
             "Added to the true yaw rate.")
      .table("wheel_scale", &Config::wheel_scale, calibrationOptions("wheel_scale", "", between(0.5, 2), 0.5),
             "Factor between measured and true way.")
      .table("latency", &Config::latency, calibrationOptions("latency", "s", between(-10, 10), 10),
             "How old a range is at its stamp.")
      .table("gate", &Config::gate, gateOptions(), "Which ranges are rejected.")
      .integer("heading_hypotheses", &Config::heading_hypotheses, between(1, 360),
               "Filters started side by side when the heading is unknown.")
      .check(kValid);
}

OptionTable<MclConfig> mclOptions() {
  return OptionTable<MclConfig>("mcl", "Particle filter on the anchors and the grid of the map.")
      .table("start", &MclConfig::start, startOptions(),
             "What is known of the pose at the first measurement.")
      .table("odometry_noise", &MclConfig::odometry_noise, odometryNoiseOptions(),
             "How odometry errors grow with way, turning and time.")
      .list("tags", &MclConfig::tags, tagOptions(),
            "Where the tags sit; goes before what the log says of it.")
      .number("body_height_m", &MclConfig::body_height, between(-10000, 10000),
              "Height of the body frame in the map.")
      .flag("use_ranges", &MclConfig::use_ranges, "Whether radio ranges weigh the particles.")
      .flag("use_scans", &MclConfig::use_scans,
            "Whether laser scans weigh the particles; the map needs a grid.")
      .table("range", &MclConfig::range, rangeLikelihoodOptions(), "How a particle is weighed by a range.")
      .table("scan", &MclConfig::scan, scanLikelihoodOptions(), "How a particle is weighed by a laser scan.")
      .table("particles", &MclConfig::particles, particleOptions(), "How many particles are kept.")
      .number("resample_below", &MclConfig::resample_below, between(0, 1),
              "Resample when the effective number of particles falls below this share.")
      .number(
          "injection_slow", &MclConfig::injection_slow, between(0, 1),
          "Decay of the slow likelihood average that decides on fresh particles; 0 means none are injected.")
      .number("injection_fast", &MclConfig::injection_fast, between(0, 1),
              "Decay of the fast likelihood average.")
      .integer("seed", &MclConfig::seed, atLeast(0),
               "Seed of its random numbers; the run's seed where absent.")
      .check(kValid);
}

OptionTable<MrptMclConfig> mrptMclOptions() {
  using Config = MrptMclConfig;
  return OptionTable<Config>("mrpt_mcl", "MRPT's own particle filter, for comparison.")
      .table("start", &Config::start, startOptions(), "What is known of the pose at the first measurement.")
      .table("odometry_noise", &Config::odometry_noise, odometryNoiseOptions(),
             "How odometry errors grow with way, turning and time.")
      .list("tags", &Config::tags, tagOptions(), "Where the tags sit; goes before what the log says of it.")
      .number("body_height_m", &Config::body_height, between(-10000, 10000),
              "Height of the body frame in the map.")
      .flag("use_ranges", &Config::use_ranges, "Whether radio ranges weigh the particles.")
      .flag("use_scans", &Config::use_scans, "Whether laser scans weigh the particles; the map needs a grid.")
      .number("range_sigma_m", &Config::range_sigma, between(0.001, 100), "Standard deviation of a range.")
      .integer("particles", &Config::particles, between(1, 10000000), "Number of particles.")
      .flag("adaptive_size", &Config::adaptive_size, "Whether KLD sampling changes the number of particles.")
      .integer("beams", &Config::beams, between(1, 100000), "Beams used, spread evenly over the scan.")
      .integer("seed", &Config::seed, atLeast(0), "Seed of its random numbers; the run's seed where absent.")
      .check(kValid);
}

OptionTable<EstimatorEntry> estimatorOptions() {
  constexpr auto config = &EstimatorEntry::config;
  return OptionTable<EstimatorEntry>("estimators", "One estimator to run.")
      .text("name", &EstimatorEntry::name,
            "Name in tables and of result files: letters, digits, _ and - only.")
      .required()
      .selector("type", "Which system it is; decides which further keys there are.")
      .alternative("dead_reckoning", config, deadReckoningOptions(),
                   "Odometry or wheels alone, from a known start.")
      .alternative("range_odometry", config, rangeOdometryOptions(),
                   "Planar Kalman filter on odometry and radio ranges.")
      .alternative("mcl", config, mclOptions(), "Particle filter on the anchors and the grid of the map.")
      .alternative("mrpt_mcl", config, mrptMclOptions(), "MRPT's own particle filter, for comparison.")
      .alternative("dual_uwb", config, dualUwbOptions(), "Two or more radio tags: pose, speed and yaw rate.")
      .alternative("sins_dr", config, sinsDrOptions(), "Inertial navigation and wheels, with slip isolation.")
      .alternative("uwb_imu", config, uwbImuOptions(), "One radio tag and an inertial unit, tightly coupled.")
      .alternative("seamless", config, seamlessOptions(),
                   "Satellites on the surface, radio under ground, one inertial unit.")
      .alternative("shearer", config, shearerOptions(),
                   "A longwall shearer among the legs of the supports, and its dead reckoning.");
}

}  // namespace pos::io
