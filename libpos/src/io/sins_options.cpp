#include "pos/io/sins_options.hpp"

#include "pos/io/estimator_options.hpp"

namespace pos::io {
namespace {

using estimation::AlignmentConfig;
using estimation::EarthModel;
using estimation::ImuNoise;
using estimation::InertialMounts;
using estimation::SinsDrConfig;
using estimation::SlipConfig;
using filters::NoiseForm;

constexpr auto kValid = [](const auto& config) { return validated(config); };

/// Three keys, x forward, y left, z up, of one place on the body.
OptionTable<Eigen::Vector3d> placeOptions(const std::string& title) {
  return OptionTable<Eigen::Vector3d>(title, "A place on the body.")
      .number(
          "x_m", [](auto& p) -> auto& { return p.x(); }, between(-100, 100), "Forward of the body frame.")
      .number(
          "y_m", [](auto& p) -> auto& { return p.y(); }, between(-100, 100), "Left of the body frame.")
      .number(
          "z_m", [](auto& p) -> auto& { return p.z(); }, between(-100, 100), "Above the body frame.");
}

}  // namespace

OptionTable<ImuNoise> imuNoiseOptions() {
  return OptionTable<ImuNoise>("imu", "What the inertial unit does wrong, as its data sheet says.")
      .number("gyro_noise_deg_per_sqrt_s", &ImuNoise::gyro_density, moreThan(0),
              "Angle random walk, the same number as deg/s/sqrt(Hz).")
      .number("accelerometer_noise_m_per_s_per_sqrt_s", &ImuNoise::accelerometer_density, moreThan(0),
              "Velocity random walk, the same number as m/s^2/sqrt(Hz).")
      .number("gyro_bias_sigma_deg_per_s", &ImuNoise::gyro_bias_sigma, between(0, 100),
              "How the gyro bias differs from switch-on to switch-on.")
      .number("accelerometer_bias_sigma_m_per_s2", &ImuNoise::accelerometer_bias_sigma, between(0, 10),
              "How the accelerometer bias differs from switch-on to switch-on.")
      .number("gyro_bias_walk_deg_per_s_per_sqrt_s", &ImuNoise::gyro_bias_walk, between(0, 10),
              "How fast the gyro bias wanders.")
      .number("accelerometer_bias_walk_m_per_s2_per_sqrt_s", &ImuNoise::accelerometer_bias_walk,
              between(0, 10), "How fast the accelerometer bias wanders.")
      .check(kValid);
}

OptionTable<InertialMounts> inertialMountOptions() {
  return OptionTable<InertialMounts>("mounts", "Where things sit on the body.")
      .table("imu", &InertialMounts::imu, placeOptions("imu"), "The inertial unit; its axes are the body's.")
      .table("axle", &InertialMounts::axle, placeOptions("axle"),
             "The middle of the axle whose wheels are read; it does not steer.");
}

OptionTable<AlignmentConfig> alignmentOptions() {
  return OptionTable<AlignmentConfig>("alignment", "Standing still before the first answer.")
      .number("time_s", &AlignmentConfig::time, between(0.5, 3600), "How long it stands.")
      .number("level_sigma_deg", &AlignmentConfig::level_sigma, between(1e-6, 10),
              "Tilt left over beyond what the accelerometer bias explains.")
      .number("moving_level_sigma_deg", &AlignmentConfig::moving_level_sigma, between(1e-3, 45),
              "Tilt left over when it moved off before the time was up.")
      .flag("zero_rate", &AlignmentConfig::zero_rate,
            "Whether standing still shows the gyro bias, now and at every stop; false only to compare.")
      .check(kValid);
}

OptionTable<ins::StandstillConfig> standstillOptions() {
  using Config = ins::StandstillConfig;
  return OptionTable<Config>("standstill", "How the inertial unit tells that the vehicle stands.")
      .number("window_s", &Config::window, between(0.05, 60), "Samples of this long are looked at.")
      .number("force_sigma_m_per_s2", &Config::force_sigma, between(1e-5, 10),
              "Standard deviation of an accelerometer sample at rest, engine running.")
      .number("rate_sigma_deg_per_s", &Config::rate_sigma, between(1e-5, 100),
              "Standard deviation of a gyro sample at rest.")
      .number("threshold", &Config::threshold, between(0.1, 10000),
              "The statistic is about 6 at rest; below this the vehicle stands.")
      .number("gravity_m_per_s2", &Config::gravity, between(9, 10.5), "Gravity of the place.")
      .check(kValid);
}

OptionTable<ins::OdometerConfig> odometerOptions() {
  using Config = ins::OdometerConfig;
  return OptionTable<Config>("odometer", "The wheels as an odometer.")
      .number("wheel_radius_m", &Config::wheel_radius, between(0, 10), "Rolling radius; for ticks.")
      .number("track_m", &Config::track, between(0, 20),
              "Between the wheels of the axle that does not steer.")
      .number("ticks_per_turn", &Config::ticks_per_turn, between(0, 1e9),
              "Counts per turn of a wheel; for ticks.")
      .integer("counter_bits", &Config::counter_bits, between(1, 62), "Width of the counters.")
      .number("noise_m_per_sqrt_m", &Config::noise_per_sqrt_m, between(0, 10),
              "How the error of a wheel's way grows.")
      .check(kValid);
}

OptionTable<SlipConfig> slipOptions() {
  using Handling = SlipConfig::Handling;
  return OptionTable<SlipConfig>("slip", "When wheels are not believed, and when they are again.")
      .choice("handling", &SlipConfig::handling,
              {{"none", Handling::None}, {"gate", Handling::Gate}, {"isolate", Handling::Isolate}},
              "Believe always; skip single comparisons only; leave the wheels out until they agree again.")
      .number("confidence", &SlipConfig::confidence, between(0.5, 0.999999),
              "A difference of the two positions beyond this share of honest ones counts against the wheels.")
      .integer("window", &SlipConfig::window, between(1, 1000), "Comparisons looked at ...")
      .integer("exceedances", &SlipConfig::exceedances, between(1, 1000),
               "... of which so many must fail for the wheels to be left out.")
      .number("release_confidence", &SlipConfig::release_confidence, between(0.1, 0.999999),
              "The velocities agree when their difference is within this share of honest ones ...")
      .integer("release_updates", &SlipConfig::release_updates, between(1, 1000),
               "... so many times in a row: then the wheels are believed again.")
      .number("release_yaw_rate_deg_per_s", &SlipConfig::release_yaw_rate, moreThan(0),
              "Wheels and gyro also have to agree on the turn within this.")
      .number("velocity_sigma_m_per_s", &SlipConfig::velocity_sigma, moreThan(0),
              "Standard deviation of the wheels' velocity in that test.")
      .number("degraded_after_s", &SlipConfig::degraded_after, moreThan(0),
              "Time without wheels after which the position is called degraded.")
      .number("max_sigma_m", &SlipConfig::max_sigma, moreThan(0),
              "When the position has become so much less sure without wheels, it is degraded too, and the "
              "velocity of steady wheels is "
              "taken.")
      .flag("standstill_updates", &SlipConfig::standstill_updates,
            "Whether a quiet inertial unit means standing while the wheels are left out.")
      .number("lateral_sigma_m_per_s", &SlipConfig::lateral_sigma, moreThan(0),
              "Sideways and upward speed while the wheels are left out.")
      .check(kValid);
}

OptionTable<SinsDrConfig> sinsDrOptions() {
  using Config = SinsDrConfig;
  return OptionTable<Config>("sins_dr", "Inertial navigation and wheels, with slip isolation.")
      .choice("variant", &Config::variant, {{"ekf", Config::Variant::Ekf}, {"iaekf", Config::Variant::Iaekf}},
              "Measurement noise as given, or learnt on the way.")
      .table("start", &Config::start, startOptions(), "Position and heading at the first measurement.")
      .number("height_m", &Config::height, between(-10000, 10000), "Height of the body frame at the start.")
      .choice("earth", &Config::earth, {{"flat", EarthModel::Flat}, {"ellipsoid", EarthModel::Ellipsoid}},
              "Flat and still, or the turning ellipsoid; the latter needs the map's origin.")
      .table("imu", &Config::imu, imuNoiseOptions(), "What the inertial unit does wrong.")
      .table("mounts", &Config::mounts, inertialMountOptions(), "Where things sit on the body.")
      .table("alignment", &Config::alignment, alignmentOptions(), "Standing still before the first answer.")
      .table("standstill", &Config::standstill, standstillOptions(), "How standing is told.")
      .table("odometer", &Config::odometer, odometerOptions(), "The wheels.")
      .number("odometer_scale_sigma", &Config::odometer_scale_sigma, between(0, 0.5),
              "How sure the wheels' scale is at the start.")
      .number("odometer_scale_walk_per_sqrt_s", &Config::odometer_scale_walk, between(0, 0.1),
              "How fast it wanders.")
      .number("odometer_velocity_sigma_m_per_s", &Config::odometer_velocity_sigma, between(0, 10),
              "White noise of the wheels' velocity, each axis and reading.")
      .number("boresight_sigma_deg", &Config::boresight_sigma, between(0, 20),
              "Mounting pitch and yaw of the inertial unit against the axle; 0 holds them at zero.")
      .number("wheels_lost_after_s", &Config::wheels_lost_after, moreThan(0),
              "After such a gap the wheels are anchored anew.")
      .number("update_interval_s", &Config::update_interval, between(0.001, 60),
              "Time between comparisons of the two positions.")
      .number("propagation_interval_s", &Config::propagation_interval, between(0.001, 1),
              "Time between steps of the covariance.")
      .number("difference_sigma_m", &Config::difference_sigma, moreThan(0),
              "Noise of the difference of the two positions; where it is learnt, its start.")
      .number("difference_sigma_min_m", &Config::difference_sigma_min, moreThan(0),
              "Floor of the learnt noise.")
      .number("difference_sigma_max_m", &Config::difference_sigma_max, moreThan(0), "Its ceiling.")
      .choice("noise_form", &Config::noise_form,
              {{"printed", NoiseForm::Printed},
               {"sage_husa", NoiseForm::SageHusa},
               {"residual", NoiseForm::Residual}},
              "How the noise is learnt: as printed, Sage and Husa, or from residuals.")
      .number("forgetting", &Config::forgetting, between(0.5, 0.99999),
              "Forgetting factor of the learnt noise; memory is about 1 / (1 - it) comparisons.")
      .number("zero_velocity_sigma_m_per_s", &Config::zero_velocity_sigma, moreThan(0),
              "How still standing is.")
      .number("fix_confidence", &Config::fix_confidence, between(0.5, 0.999999),
              "An outside fix further off than this share of honest ones is rejected.")
      .table("slip", &Config::slip, slipOptions(), "When wheels are not believed.")
      .check(kValid);
}

}  // namespace pos::io
