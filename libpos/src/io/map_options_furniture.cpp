#include "map_options.hpp"

namespace pos::io {
namespace {

using namespace pos::map;

/// Id, and the place that most objects have.
template <class Object>
OptionTable<Object> placedOptions(const std::string& title, const std::string& text) {
  return OptionTable<Object>(title, text)
      .text("id", &Object::id, "Id that stays the same from version to version.")
      .required()
      .text(
          "roadway", [](auto& object) -> auto& { return object.place.roadway; }, "Id of the roadway.")
      .required()
      .number(
          "chainage_m", [](auto& object) -> auto& { return object.place.chainage; }, anything(),
          "Chainage of its middle.")
      .required();
}

}  // namespace

OptionTable<Chamber> chamberOptions() {
  return placedOptions<Chamber>("chambers", "A niche where vehicles wait or people step aside.")
      .text("name", &Chamber::name, "Name on drawings and in messages.")
      .choice("side", &Chamber::side, sideNames(), "Its wall, seen along growing chainage.")
      .required()
      .choice("kind", &Chamber::kind,
              {{"passing", Chamber::Kind::Passing}, {"refuge", Chamber::Kind::Refuge}},
              "Whether vehicles can wait in it.")
      .number("length_m", &Chamber::length, between(0, 1000), "Room along the roadway.")
      .required()
      .number("depth_m", &Chamber::depth, between(0, 100), "Depth into the wall.")
      .integer("capacity", &Chamber::capacity, between(0, 1000), "How many vehicles it holds.")
      .number("detection_sigma_m", &Chamber::detection_sigma, moreThan(0),
              "How well passing it is noticed along the roadway, standard deviation.");
}

OptionTable<Portal> portalOptions() {
  return placedOptions<Portal>("portals", "Where a roadway reaches the surface.")
      .text("name", &Portal::name, "Name on drawings and in messages.")
      .number("handover_from_m", &Portal::handover_from, anything(),
              "Chainage where the zone of hand-over between satellites and radio begins.")
      .required()
      .number("handover_to_m", &Portal::handover_to, anything(), "Chainage where it ends.")
      .required();
}

OptionTable<Light> lightOptions() {
  return placedOptions<Light>("lights", "A signal lamp.")
      .choice("side", &Light::side, sideNames(), "Its wall, seen along growing chainage.")
      .choice("controls", &Light::controls, directionNames(), "The traffic that has to obey it.")
      .required();
}

OptionTable<StopLine> stopLineOptions() {
  return placedOptions<StopLine>("stop_lines", "The line before which a vehicle waits.")
      .choice("controls", &StopLine::controls, directionNames(), "The traffic that has to stop.")
      .required()
      .text("light", &StopLine::light, "Id of the light it belongs to.");
}

OptionTable<RestrictedZone> zoneOptions() {
  return OptionTable<RestrictedZone>("zones", "A stretch with a rule of its own.")
      .text("id", &RestrictedZone::id, "Id that stays the same from version to version.")
      .required()
      .text("name", &RestrictedZone::name, "Name on drawings and in messages.")
      .text(
          "roadway", [](auto& zone) -> auto& { return zone.stretch.roadway; }, "Id of the roadway.")
      .required()
      .number(
          "from_m", [](auto& zone) -> auto& { return zone.stretch.from; }, anything(),
          "Chainage where it begins.")
      .required()
      .number(
          "to_m", [](auto& zone) -> auto& { return zone.stretch.to; }, anything(), "Chainage where it ends.")
      .required()
      .choice("kind", &RestrictedZone::kind,
              {{"no_entry", RestrictedZone::Kind::NoEntry},
               {"no_meeting", RestrictedZone::Kind::NoMeeting},
               {"speed_limit", RestrictedZone::Kind::SpeedLimit}},
              "What is not allowed in it.")
      .required()
      .number("speed_limit_m_per_s", &RestrictedZone::speed_limit, moreThan(0),
              "Speed limit, for kind speed_limit.");
}

OptionTable<Requirements> requirementOptions() {
  const auto vehicle =
      OptionTable<SiteVehicle>("vehicles", "A kind of vehicle that drives here, with its load.")
          .text("id", &SiteVehicle::id, "Id that stays the same from version to version.")
          .required()
          .number("width_m", &SiteVehicle::width, moreThan(0), "Width.")
          .required()
          .number("height_m", &SiteVehicle::height, moreThan(0), "Height above the floor.")
          .required()
          .number("length_m", &SiteVehicle::length, moreThan(0), "Length.")
          .required();
  return OptionTable<Requirements>("requirements", "What the site has to offer; the checks ask for it.")
      .integer("anchors_visible", &Requirements::anchors_visible, between(0, 1000),
               "How many anchors a tag has to see from everywhere; 0 is not asked for.")
      .number("range_limit_m", &Requirements::range_limit, moreThan(0), "Range of the radio.")
      .number("tag_height_m", &Requirements::tag_height, between(0, 100),
              "Height of the tag above the floor.")
      .list("vehicles", &Requirements::vehicles, vehicle, "Vehicles that every roadway has to let through.");
}

OptionTable<BackgroundImage> backgroundOptions() {
  const auto point = OptionTable<ControlPoint>("control_points", "A point of the picture found on the map.")
                         .number("column", &ControlPoint::column, anything(), "Pixels from the left edge.")
                         .required()
                         .number("row", &ControlPoint::row, anything(), "Pixels from the upper edge.")
                         .required()
                         .number("x_m", &ControlPoint::x, anything(), "East in the map.")
                         .required()
                         .number("y_m", &ControlPoint::y, anything(), "North in the map.")
                         .required();
  return OptionTable<BackgroundImage>("background", "A scanned plan to draw under the map.")
      .text("file", &BackgroundImage::file, "The picture, relative to the map's folder.")
      .required()
      .list("control_points", &BackgroundImage::control_points, point,
            "At least three points, not on one line.")
      .required();
}

}  // namespace pos::io
