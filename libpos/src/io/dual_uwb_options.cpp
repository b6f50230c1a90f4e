#include "pos/io/estimator_options.hpp"

namespace pos::io {
namespace {

using estimation::DualUwbConfig;
using estimation::LinkBias;
using estimation::SightConfig;
using estimation::TagShift;

OptionTable<SightConfig> sightOptions() {
  return OptionTable<SightConfig>("gate", "Which ranges are rejected, and what follows from it.")
      .number("confidence", &SightConfig::confidence, between(0.5, 0.999999),
              "A range further off than this share of good ranges would be is rejected.")
      .integer("blocked_after", &SightConfig::blocked_after, between(1, 1000),
               "An anchor rejected this many times in a row is taken to be hidden.")
      .number("blocked_for_s", &SightConfig::blocked_for, between(0, 3600),
              "The anchor is left alone this long.")
      .number("restart_after_s", &SightConfig::restart_after, between(0.1, 3600),
              "After this long without agreement the filter starts over from the ranges.")
      .number("agreement_fraction", &SightConfig::agreement_fraction, between(0, 1),
              "Agreement means that at least this share of the anchors heard pass the gate.")
      .check([](const auto& config) { return validated(config); });
}

OptionTable<Eigen::Vector2d> cornerOptions() {
  return OptionTable<Eigen::Vector2d>("corner", "A corner of the roadway.")
      .number(
          "x_m", [](auto& corner) -> auto& { return corner.x(); }, anything(), "East in the map.")
      .required()
      .number(
          "y_m", [](auto& corner) -> auto& { return corner.y(); }, anything(), "North in the map.")
      .required();
}

}  // namespace

OptionTable<LinkBias> linkBiasOptions() {
  return OptionTable<LinkBias>("link", "What one tag and one anchor read too long.")
      .integer("tag", &LinkBias::tag, anything(), "The radio's own number of the tag.")
      .required()
      .integer("anchor", &LinkBias::anchor, anything(), "The radio's own number of the anchor.")
      .required()
      .number("bias_m", &LinkBias::bias, between(-100, 100), "Subtracted from every range of the link.")
      .required();
}

OptionTable<TagShift> tagShiftOptions() {
  return OptionTable<TagShift>("tag_shift", "How far a tag's electrical place lies from its mount.")
      .integer("id", &TagShift::id, anything(), "The radio's own number of the tag.")
      .required()
      .number("x_m", &TagShift::x, between(-10, 10), "Forward of the mount.")
      .required()
      .number("y_m", &TagShift::y, between(-10, 10), "Left of the mount.")
      .required();
}

OptionTable<DualUwbConfig> dualUwbOptions() {
  using Config = DualUwbConfig;
  using Variant = Config::Variant;
  return OptionTable<Config>("dual_uwb", "Two or more radio tags: pose, speed and yaw rate.")
      .choice("variant", &Config::variant,
              {{"snapshot", Variant::Snapshot},
               {"differential", Variant::Differential},
               {"rigid", Variant::Rigid},
               {"filter", Variant::Filter},
               {"filter_gyro", Variant::FilterGyro}},
              "One pose an epoch from the tags by themselves, the same summed up by increments, from all "
              "ranges at "
              "once; or a Kalman filter on the ranges, without or with a gyro.")
      .choice("motion", &Config::motion,
              {{"vehicle", Config::Motion::Vehicle}, {"free", Config::Motion::Free}},
              "Whether it drives where its wheels point, or may slide (filters).")
      .table("start", &Config::start, startOptions(), "What is known of the pose at the first measurement.")
      .number("still_at_start_s", &Config::still_at_start, between(0, 3600),
              "The vehicle is known to stand this long after the first fix (filters).")
      .list(
          "tags", &Config::tags, tagOptions(),
          "The tags that are used and where they sit; without a list all that the log places on the vehicle.")
      .number("body_height_m", &Config::body_height, between(-10000, 10000),
              "Height of the body frame in the map.")
      .number("range_sigma_m", &Config::range_sigma, between(0.0001, 100), "Standard deviation of a range.")
      .number("range_offset_m", &Config::range_offset, between(-100, 100), "Subtracted from every range.")
      .table("link_bias", &Config::link_bias, calibrationOptions("link_bias", "m", between(-100, 100), 100),
             "What a link reads too long, one state for each tag and anchor (filters).")
      .text("range_bias_table", &Config::range_bias_table,
            "File written by pos calibrate ranges; it stands in the place of range_offset_m, range_biases "
            "and tag_shifts.")
      .list("range_biases", &Config::range_biases, linkBiasOptions(), "What single links read too long.")
      .list("tag_shifts", &Config::tag_shifts, tagShiftOptions(),
            "How far the tags' electrical places lie from their mounts.")
      .number("epoch_span_s", &Config::epoch_span, between(0, 60),
              "Ranges within it count as taken at once (snapshot, differential, rigid).")
      .number("acceleration_density_m_per_s_per_sqrt_s", &Config::acceleration_density, between(0.0001, 1000),
              "How fast the speed wanders (filters).")
      .number("yaw_acceleration_density_deg_per_s_per_sqrt_s", &Config::yaw_acceleration_density,
              between(0.0001, 10000), "How fast the yaw rate wanders (filters).")
      .number("max_speed_m_per_s", &Config::max_speed, between(0.01, 100),
              "Fastest speed; sets how unsure the speed is at the start and a held pose grows.")
      .number("max_yaw_rate_deg_per_s", &Config::max_yaw_rate, between(0.01, 3600),
              "Fastest turn; sets how unsure the yaw rate is at the start and a held heading grows.")
      .number("motion_centre_x_m", &Config::motion_centre_x, between(-100, 100),
              "How far the body frame lies ahead of the point that the vehicle turns about (filters).")
      .number("course_offset_deg", &Config::course_offset, between(-180, 180),
              "How far left of the body's x axis the course lies when driving straight (filters).")
      .number("lateral_sigma_m_per_s", &Config::lateral_sigma, between(0, 100),
              "How well the wheels keep a vehicle in free motion from sliding; 0 means not at all.")
      .number("wheel_speed_sigma_m_per_s", &Config::wheel_speed_sigma, between(0, 100),
              "Standard deviation of the wheels' speed; 0 means it is not used.")
      .number("gyro_noise_deg_per_sqrt_s", &Config::gyro_noise, between(0, 1000),
              "Angle random walk of the gyro (filter_gyro).")
      .table("gyro_bias", &Config::gyro_bias,
             calibrationOptions("gyro_bias", "deg_per_s", between(-100, 100), 100),
             "Added by the gyro to the true yaw rate (filter_gyro).")
      .flag("never_reverses", &Config::never_reverses,
            "Whether driving backwards is ruled out: then it tells mirror images apart and swapped tags.")
      .table("gate", &Config::gate, sightOptions(), "Which ranges are rejected, and what follows from it.")
      .number("fit_significance", &Config::fit_significance, between(0.000001, 0.5),
              "Share of good epochs that are searched for bad ranges all the same.")
      .list("roadway", &Config::roadway, cornerOptions(),
            "Corners of the ground the vehicle can be on; it tells mirror images apart.")
      .check([](const auto& config) { return validated(config); });
}

}  // namespace pos::io
