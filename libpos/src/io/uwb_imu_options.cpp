#include "pos/io/uwb_imu_options.hpp"

#include "pos/io/estimator_options.hpp"
#include "pos/io/sins_options.hpp"

namespace pos::io {
namespace {

using estimation::AnchorBiasConfig;
using estimation::InertialStart;
using estimation::MotionAids;
using estimation::RecoveryConfig;
using estimation::UwbImuConfig;
using filters::RobustConfig;

constexpr auto kValid = [](const auto& config) { return validated(config); };

}  // namespace

OptionTable<InertialStart> inertialStartOptions() {
  using Levelling = InertialStart::Levelling;
  return OptionTable<InertialStart>("first", "What is known of level, speed and height at the start.")
      .choice("levelling", &InertialStart::levelling,
              {{"at_rest", Levelling::AtRest}, {"in_motion", Levelling::InMotion}},
              "Stands first and levels itself; or drives already, level and with the speed given.")
      .number("speed_m_per_s", &InertialStart::speed, between(-50, 50), "Forward, for in_motion.")
      .number("velocity_sigma_m_per_s", &InertialStart::velocity_sigma, moreThan(0),
              "How sure the velocity is, each axis.")
      .number("tilt_sigma_deg", &InertialStart::tilt_sigma, between(1e-6, 45),
              "How level it is, roll and pitch, for in_motion.")
      .number("height_sigma_m", &InertialStart::height_sigma, moreThan(0), "How sure the height is.")
      .check(kValid);
}

OptionTable<RobustConfig> robustOptions() {
  using Form = RobustConfig::Form;
  return OptionTable<RobustConfig>("robust", "How far a range that surprises is believed.")
      .choice("form", &RobustConfig::form,
              {{"none", Form::None}, {"huber", Form::Huber}, {"igg3", Form::Igg3}},
              "Every range in full; less and less beyond k0; the same, and nothing at k1.")
      .number("k0", &RobustConfig::k0, moreThan(0), "Sigmas within which a range is good.")
      .number("k0_upward", &RobustConfig::k0_upward, moreThan(0),
              "The same for ranges that are too long, as those of hidden anchors are.")
      .number("k1", &RobustConfig::k1, moreThan(0), "Sigmas beyond which a range is rejected.")
      .check(kValid);
}

OptionTable<AnchorBiasConfig> anchorBiasOptions() {
  return OptionTable<AnchorBiasConfig>("anchor_bias", "An offset of one anchor's ranges as a further state.")
      .number("sigma_m", &AnchorBiasConfig::sigma, between(0, 100),
              "How large it may be; 0 means no such states.")
      .number("time_s", &AnchorBiasConfig::time, moreThan(0), "It forgets itself over this time.")
      .number("after_s", &AnchorBiasConfig::after, moreThan(0),
              "An anchor that surprises for so long gets its state.")
      .number("drop_after_s", &AnchorBiasConfig::drop_after, moreThan(0),
              "One that does not surprise for so long loses it.")
      .check(kValid);
}

OptionTable<RecoveryConfig> recoveryOptions() {
  return OptionTable<RecoveryConfig>("recovery", "When the filter doubts itself instead of the ranges.")
      .number("after_s", &RecoveryConfig::after, between(0.1, 3600),
              "After so long with hardly a range accepted it becomes unsure and takes ranges again.")
      .number("agreement_fraction", &RecoveryConfig::agreement_fraction, between(0, 1),
              "It is not lost while at least this share of the anchors heard is accepted.")
      .check(kValid);
}

OptionTable<MotionAids> motionAidOptions() {
  return OptionTable<MotionAids>("aids", "What else is known of the motion; 0 switches one off.")
      .number("height_sigma_m", &MotionAids::height_sigma, between(0, 1000),
              "The body keeps the height it started with, this well.")
      .number("zero_velocity_sigma_m_per_s", &MotionAids::zero_velocity_sigma, between(0, 10),
              "How still standing is; the gyros then show their bias.")
      .number("lateral_sigma_m_per_s", &MotionAids::lateral_sigma, between(0, 10),
              "Sideways and upward speed of the axle that does not steer.")
      .number("wheel_speed_sigma_m_per_s", &MotionAids::wheel_speed_sigma, between(0, 10),
              "Noise of the wheels' speed.")
      .number("interval_s", &MotionAids::interval, moreThan(0), "Time between two uses of one of them.")
      .check(kValid);
}

OptionTable<UwbImuConfig> uwbImuOptions() {
  using Config = UwbImuConfig;
  using Variant = Config::Variant;
  return OptionTable<Config>("uwb_imu", "One radio tag and an inertial unit, tightly coupled.")
      .choice("variant", &Config::variant,
              {{"uwb_only", Variant::UwbOnly},
               {"ekf", Variant::Ekf},
               {"ukf", Variant::Ukf},
               {"eskf", Variant::Eskf}},
              "A fix for each epoch without inertial unit; quaternion as four states; sigma points; error "
              "states.")
      .table("start", &Config::start, startOptions(), "Position and heading at the first measurement.")
      .number("height_m", &Config::height, between(-10000, 10000), "Height of the body frame at the start.")
      .table("first", &Config::first, inertialStartOptions(), "Level, speed and height at the start.")
      .table("imu", &Config::imu, imuNoiseOptions(), "What the inertial unit does wrong.")
      .table("mounts", &Config::mounts, inertialMountOptions(), "Where things sit on the body.")
      .table("alignment", &Config::alignment, alignmentOptions(), "Standing still before the first answer.")
      .table("standstill", &Config::standstill, standstillOptions(), "How standing is told.")
      .table("odometer", &Config::odometer, odometerOptions(), "The wheels, where they are used.")
      .list("tags", &Config::tags, tagOptions(), "The tags used; none: all, where the log says they sit.")
      .number("range_sigma_m", &Config::range_sigma, between(0.001, 100), "Standard deviation of a range.")
      .number("range_max_m", &Config::range_max, moreThan(0), "Longer ranges are no ranges.")
      .table("robust", &Config::robust, robustOptions(), "How far a range that surprises is believed.")
      .number("power_gap_db", &Config::power_gap_db, between(0, 100),
              "A first path so much weaker than the whole makes a range doubtful; 0 means not looked at.")
      .number("power_factor", &Config::power_factor, atLeast(1), "Times the variance of such a range.")
      .table("anchor_bias", &Config::anchor_bias, anchorBiasOptions(),
             "Offsets of anchors as states, for eskf.")
      .table("recovery", &Config::recovery, recoveryOptions(), "When the filter doubts itself.")
      .table("aids", &Config::aids, motionAidOptions(), "What else is known of the motion.")
      .number("epoch_span_s", &Config::epoch_span, between(0, 10),
              "For uwb_only: ranges within it count as taken at once.")
      .number("max_speed_m_per_s", &Config::max_speed, moreThan(0),
              "For uwb_only: how unsure a fix becomes while none follows.")
      .number("sigma_point_spread", &Config::sigma_point_spread, between(1e-5, 1), "Alpha, for ukf.")
      .number("lag_s", &Config::lag, between(0, 10),
              "So late may a measurement come and still be put in its place; 0 where the sequencer sorts.")
      .check(kValid);
}

}  // namespace pos::io
