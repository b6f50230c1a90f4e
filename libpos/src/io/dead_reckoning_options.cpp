#include "pos/io/estimator_options.hpp"
#include "pos/io/sins_options.hpp"

namespace pos::io {

using estimation::DeadReckoningConfig;
using estimation::HeadingFilterConfig;

namespace {

constexpr auto kValid = [](const auto& config) { return validated(config); };

OptionTable<HeadingFilterConfig> headingFilterOptions() {
  using Config = HeadingFilterConfig;
  return OptionTable<Config>("heading", "How the wheels' turns and the inertial attitude are weighed.")
      .number("level_walk_deg_per_sqrt_s", &Config::level_walk, between(0, 90), "How climb and roll change.")
      .number("level_sigma_deg", &Config::level_sigma, between(1e-4, 90),
              "Standard deviation of the inertial climb and roll.")
      .number("yaw_sigma_deg", &Config::yaw_sigma, between(1e-4, 180),
              "Standard deviation of the inertial heading.")
      .number("correlation_time_s", &Config::correlation_time, between(0, 1e6),
              "For so long the error of that heading stays the same; about the length of the run. 0: white.")
      .table("yaw_bias", &Config::yaw_bias, calibrationOptions("yaw_bias", "deg", between(-180, 180), 180),
             "State: the inertial heading reads too much.")
      .table("track_error", &Config::track_error,
             calibrationOptions("track_error", "", between(-0.5, 0.5), 0.5),
             "State: the track is too large by this share.")
      .check(kValid);
}

}  // namespace

OptionTable<DeadReckoningConfig> deadReckoningOptions() {
  using Config = DeadReckoningConfig;
  using Variant = Config::Variant;
  return OptionTable<Config>("dead_reckoning", "Odometry or wheels alone, from a known start.")
      .choice("variant", &Config::variant,
              {{"odometry", Variant::Odometry},
               {"encoders", Variant::Encoders},
               {"encoders_attitude", Variant::EncodersAttitude},
               {"ekf_heading", Variant::EkfHeading}},
              "Odometry increments as they come; two wheels alone; their way with the gyros' attitude; both "
              "headings in a filter. All but the first need `odometer`.")
      .table("start", &Config::start, startOptions(), "What is known of the pose at the first measurement.")
      .table("odometry_noise", &Config::noise, odometryNoiseOptions(),
             "How odometry errors grow with way, turning and time; for the variant odometry.")
      .number("height_m", &Config::height, between(-10000, 10000), "Height of the body frame at the start.")
      .choice("earth", &Config::earth,
              {{"flat", estimation::EarthModel::Flat}, {"ellipsoid", estimation::EarthModel::Ellipsoid}},
              "Flat and still, or the turning ellipsoid; the latter needs the map's origin.")
      .table("imu", &Config::imu, imuNoiseOptions(), "What the inertial unit does wrong.")
      .table("mounts", &Config::mounts, inertialMountOptions(), "Where things sit on the body.")
      .table("alignment", &Config::alignment, alignmentOptions(), "Standing still before the first answer.")
      .table("standstill", &Config::standstill, standstillOptions(), "How standing is told.")
      .table("odometer", &Config::odometer, odometerOptions(), "The wheels.")
      .table("wheel_scale", &Config::wheel_scale,
             calibrationOptions("wheel_scale", "", between(-0.5, 0.5), 0.5),
             "Wheels read (1 + it) times the way.")
      .table("heading", &Config::heading, headingFilterOptions(), "The filter of ekf_heading.")
      .check(kValid);
}

}  // namespace pos::io
