/// Option tables of satellite fixes and passages.
#include "scenario_options.hpp"

namespace pos::io {
namespace {

using namespace pos::sim;

OptionTable<GnssZone> gnssZoneOptions() {
  OptionTable<GnssZone> table("zones", "How the receiver does somewhere; the first that holds counts.");
  return withZone(table)
      .flag("masked", &GnssZone::masked, "Whether there are no fixes at all.")
      .number("vertical_factor", &GnssZone::vertical_factor, moreThan(0), "Noise of the height, as a factor.")
      .numbers("bias_m", &GnssZone::bias, anything(), "Constant error, map axes.")
      .choice("quality", &GnssZone::quality,
              {{"none", GnssFix::Quality::None},
               {"autonomous", GnssFix::Quality::Autonomous},
               {"differential", GnssFix::Quality::Differential},
               {"rtk_float", GnssFix::Quality::RtkFloat},
               {"rtk_fixed", GnssFix::Quality::RtkFixed}},
              "What the receiver calls its fix.");
}

OptionTable<PassagePlace> placeOptions() {
  return OptionTable<PassagePlace>("places", "A place that can be detected.")
      .text("name", &PassagePlace::name, "Its name in the fixes.")
      .required()
      .number(
          "x_m", [](auto& p) -> auto& { return p.p_map.x(); }, anything(), "East in the map.")
      .required()
      .number(
          "y_m", [](auto& p) -> auto& { return p.p_map.y(); }, anything(), "North in the map.")
      .required()
      .number(
          "z_m", [](auto& p) -> auto& { return p.p_map.z(); }, anything(), "Height in the map.");
}

}  // namespace

OptionTable<GnssConfig> gnssOptions() {
  OptionTable<GnssConfig> table("gnss", "Satellite fixes.");
  addTiming(table, &GnssConfig::timing);
  addPlace(table, &GnssConfig::antenna_body, "Antenna,");
  return table
      .list("zones", &GnssConfig::zones, gnssZoneOptions(),
            "How the receiver does where; no fix outside all.")
      .required()
      .number("correlation_time_s", &GnssConfig::correlation_time, atLeast(0),
              "Of the errors (first-order Gauss-Markov); 0 is white.")
      .number("stale_s", &GnssConfig::stale, atLeast(0),
              "How long after a change of zone the receiver still claims what it claimed before.")
      .number("claimed_sigma_m", &GnssConfig::claimed_sigma, moreThan(0),
              "What fixes say of their noise; the truth where absent.");
}

OptionTable<PassageConfig> passageOptions() {
  OptionTable<PassageConfig> table("passages", "Detections of known places: chambers, portal readers.");
  addTiming(table, &PassageConfig::timing);
  addPlace(table, &PassageConfig::antenna_body, "Antenna,");
  return table
      .choice("style", &PassageConfig::style,
              {{"closest_approach", PassageStyle::ClosestApproach}, {"reader", PassageStyle::Reader}},
              "A radio that finds the moment of closest approach, or a reader with a field.")
      .list("places", &PassageConfig::places, placeOptions(), "Places that can be detected.")
      .required()
      .number("radius_m", &PassageConfig::radius, moreThan(0), "Farther passages are not seen.")
      .number("rise_m", &PassageConfig::rise, moreThan(0),
              "For closest_approach: the passage is known once the antenna is so much farther again.")
      .number("sigma_m", &PassageConfig::sigma, atLeast(0), "Along the way, for closest_approach.")
      .number("sigma_time_s", &PassageConfig::sigma_time, atLeast(0), "Of the moment, for closest_approach.")
      .number("sigma_across_m", &PassageConfig::sigma_across, moreThan(0),
              "Said of the error across the way and in height.")
      .number("missed_probability", &PassageConfig::missed_probability, between(0, 1), "Of each passage.")
      .number("wrong_probability", &PassageConfig::wrong_probability, between(0, 1),
              "Of a passage that carries another place's name.");
}

}  // namespace pos::io
