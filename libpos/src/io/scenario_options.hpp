#pragma once
/// Option tables of a scenario's parts.

#include "pos/io/options.hpp"
#include "pos/sim/scenario.hpp"

namespace pos::io {
namespace detail {

/// [at the zone's beginning, at its end].
template <>
struct NumberList<sim::SigmaRamp> {
  static constexpr std::size_t kCount = 2;
  static sim::SigmaRamp of(const std::vector<double>& values) { return {values[0], values[1]}; }
  static std::vector<double> values(const sim::SigmaRamp& ramp) { return {ramp.first, ramp.last}; }
};

}  // namespace detail

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

/// The keys of the span of time that `span` gives.
template <class T, class Member>
OptionTable<T>& withSpan(OptionTable<T>& table, Member span) {
  return table
      .number(
          "from_s", [span](auto& s) -> auto& { return std::invoke(span, s).from; }, anything(),
          "Begin, after the scenario's start.")
      .required()
      .number(
          "to_s", [span](auto& s) -> auto& { return std::invoke(span, s).to; }, anything(),
          "End; the moment itself is outside.")
      .required();
}

/// from_s and to_s of a span of time.
OptionTable<sim::TimeSpan> spanOptions(const std::string& key, const std::string& text);

/// The keys of a zone that `where` gives.
template <class T>
OptionTable<T>& withZone(OptionTable<T>& table) {
  return table
      .text(
          "name", [](auto& zone) -> auto& { return zone.where.name; }, "Name in messages.")
      .table(
          "time", [](auto& zone) -> auto& { return zone.where.time; },
          spanOptions("time", "When it holds; always where absent."), "When it holds; always where absent.")
      .list(
          "place", [](auto& zone) -> auto& { return zone.where.place; }, outlinePointOptions(),
          "Outline in which it holds; everywhere where empty.")
      .numbers(
          "ramp_from_m", [](auto& zone) -> auto& { return zone.where.ramp_from; }, anything(),
          "x and y at which the zone begins, where its noise changes along a way instead of in time.")
      .numbers(
          "ramp_to_m", [](auto& zone) -> auto& { return zone.where.ramp_to; }, anything(),
          "x and y at which it ends.")
      .numbers(
          "sigma_m", [](auto& zone) -> auto& { return zone.sigma; }, atLeast(0),
          "Standard deviation at its beginning and at its end, evenly in the logarithm between.");
}

/// When a sensor measures and when its readings arrive; `timing` gives the struct.
template <class T, class Member>
void addTiming(OptionTable<T>& table, Member timing) {
  const auto part = [timing](auto field) {
    return [ timing, field ](auto& sensor) -> auto& {
      return std::invoke(timing, sensor).*field;
    };
  };
  using sim::Timing;
  table.number("rate_hz", part(&Timing::rate), moreThan(0), "Readings per second.")
      .number("phase_s", part(&Timing::phase), atLeast(0), "Moment of the first reading.")
      .number("sampling_jitter_s", part(&Timing::jitter), atLeast(0),
              "How much the moments of measuring stray from their beat, standard deviation.")
      .number("latency_s", part(&Timing::latency), atLeast(0), "From measuring to arrival.")
      .number("latency_jitter_s", part(&Timing::latency_jitter), atLeast(0),
              "How much the latency varies, standard deviation.")
      .number("stamp_error_s", part(&Timing::stamp_error), anything(),
              "Added to every stamp: a clock that is off.")
      .number("loss_probability", part(&Timing::drop_probability), between(0, 1),
              "Share of the readings that never arrive.")
      .list("outages", part(&Timing::outages), spanOptions("outages", "A time without readings."),
            "Times without readings.");
}

}  // namespace pos::io
