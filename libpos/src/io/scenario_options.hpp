#pragma once
/// Option tables of a scenario's parts.

#include "pos/io/options.hpp"
#include "pos/sim/scenario.hpp"

namespace pos::io {

OptionTable<sim::Vehicle> vehicleOptions();
OptionTable<sim::MotionConfig> motionOptions();
OptionTable<sim::ImuModel> imuModelOptions();
OptionTable<sim::EncoderModel> encoderModelOptions();
OptionTable<sim::UwbConfig> uwbOptions();
OptionTable<sim::GnssConfig> gnssOptions();
OptionTable<sim::LidarConfig> lidarOptions();
OptionTable<sim::SupportLegSensor> supportLegOptions();
OptionTable<sim::PassageConfig> passageOptions();

/// The points of a closed outline.
OptionTable<Eigen::Vector2d> outlinePointOptions();

/// x_m, y_m, z_m of a place given by `member`.
template <class T, class Member>
void addPlace(OptionTable<T>& table, Member member, const std::string& of) {
  table
      .number(
          "x_m", [member](auto& object) -> auto& { return std::invoke(member, object).x(); }, anything(),
          of + " ahead of the body origin.")
      .number(
          "y_m", [member](auto& object) -> auto& { return std::invoke(member, object).y(); }, anything(),
          of + " left of it.")
      .number(
          "z_m", [member](auto& object) -> auto& { return std::invoke(member, object).z(); }, anything(),
          of + " above it.");
}

/// from_s and to_s of anything with `from` and `to`.
template <class Span>
OptionTable<Span> spanOptions(const std::string& key, const std::string& text) {
  return OptionTable<Span>(key, text)
      .number("from_s", &Span::from, anything(), "Begin, after the scenario's start.")
      .required()
      .number("to_s", &Span::to, anything(), "End; the moment itself is outside.")
      .required();
}

/// The two timing structs of the sensors under common names.
struct TimingMembers {
  static auto& latencyJitter(auto& t) {
    if constexpr (requires { t.latency_jitter; }) {
      return t.latency_jitter;
    } else {
      return t.jitter_sigma;
    }
  }
  static auto& stampError(auto& t) {
    if constexpr (requires { t.stamp_error; }) {
      return t.stamp_error;
    } else {
      return t.stamp_offset;
    }
  }
  static auto& loss(auto& t) {
    if constexpr (requires { t.drop_probability; }) {
      return t.drop_probability;
    } else {
      return t.loss_probability;
    }
  }
};

/// When a sensor measures and when its readings arrive; `timing` gives the struct.
template <class T, class Member>
void addTiming(OptionTable<T>& table, Member timing) {
  using Timing = std::remove_cvref_t<std::invoke_result_t<Member, T&>>;
  table
      .number(
          "rate_hz", [timing](auto& s) -> auto& { return std::invoke(timing, s).rate; }, moreThan(0),
          "Readings per second.")
      .number(
          "phase_s", [timing](auto& s) -> auto& { return std::invoke(timing, s).phase; }, atLeast(0),
          "Moment of the first reading.");
  if constexpr (requires(Timing t) { t.jitter; }) {
    table.number(
        "sampling_jitter_s", [timing](auto& s) -> auto& { return std::invoke(timing, s).jitter; }, atLeast(0),
        "How much the moments of measuring stray from their beat, standard deviation.");
  }
  table
      .number(
          "latency_s", [timing](auto& s) -> auto& { return std::invoke(timing, s).latency; }, atLeast(0),
          "From measuring to arrival.")
      .number(
          "latency_jitter_s",
          [timing](auto& s) -> auto& { return TimingMembers::latencyJitter(std::invoke(timing, s)); },
          atLeast(0), "How much the latency varies, standard deviation.")
      .number(
          "stamp_error_s",
          [timing](auto& s) -> auto& { return TimingMembers::stampError(std::invoke(timing, s)); },
          anything(), "Added to every stamp: a clock that is off.")
      .number(
          "loss_probability",
          [timing](auto& s) -> auto& { return TimingMembers::loss(std::invoke(timing, s)); }, between(0, 1),
          "Share of the readings that never arrive.")
      .list(
          "outages", [timing](auto& s) -> auto& { return std::invoke(timing, s).outages; },
          spanOptions<typename decltype(Timing::outages)::value_type>("outages", "A time without readings."),
          "Times without readings.");
}

}  // namespace pos::io
