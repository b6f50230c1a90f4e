#include "map_options.hpp"

namespace pos::io {
namespace {

using namespace pos::map;

OptionTable<CentrelinePoint> pointOptions() {
  return OptionTable<CentrelinePoint>("centreline", "A point on the floor in the middle of the roadway.")
      .number(
          "x_m", [](auto& point) -> auto& { return point.p_map.x(); }, anything(), "East in the map.")
      .required()
      .number(
          "y_m", [](auto& point) -> auto& { return point.p_map.y(); }, anything(), "North in the map.")
      .required()
      .number(
          "z_m", [](auto& point) -> auto& { return point.p_map.z(); }, anything(), "Height of the floor.")
      .required()
      .number("arc_deg", &CentrelinePoint::arc, between(-355, 355),
              "Angle swept on the way to the next point, counter-clockwise; 0 is a straight line.")
      .number("station_m", &CentrelinePoint::station, anything(),
              "Chainage as surveyed; it is compared with the length and not used otherwise.");
}

OptionTable<RoadwayPlace> placeOptions(const std::string& title, const std::string& text) {
  return OptionTable<RoadwayPlace>(title, text)
      .text("roadway", &RoadwayPlace::roadway, "Id of the roadway.")
      .required()
      .number("chainage_m", &RoadwayPlace::chainage, anything(), "Chainage on it.")
      .required();
}

OptionTable<RoadwayStretch> legOptions() {
  return OptionTable<RoadwayStretch>("legs", "A part of a route on one roadway.")
      .text("roadway", &RoadwayStretch::roadway, "Id of the roadway.")
      .required()
      .number("from_m", &RoadwayStretch::from, anything(), "Chainage where the leg begins.")
      .required()
      .number("to_m", &RoadwayStretch::to, anything(),
              "Chainage where it ends; smaller than from_m when driven against the chainage.")
      .required();
}

}  // namespace

std::vector<NamedValue<Side>> sideNames() {
  return {{"left", Side::Left}, {"right", Side::Right}};
}
std::vector<NamedValue<Direction>> directionNames() {
  return {{"forward", Direction::Forward}, {"backward", Direction::Backward}};
}

OptionTable<Roadway> roadwayOptions() {
  return OptionTable<Roadway>("roadways", "A roadway along its centreline.")
      .text("id", &Roadway::id, "Id that stays the same from version to version.")
      .required()
      .text("name", &Roadway::name, "Name on drawings and in messages.")
      .text("level", &Roadway::level, "Name of the working level.")
      .number("width_m", &Roadway::width, between(0.5, 100), "Width between the walls.")
      .required()
      .number("height_m", &Roadway::height, between(0.5, 100), "Height from floor to roof in the middle.")
      .required()
      .choice("section", &Roadway::section, {{"rectangle", Section::Rectangle}, {"arch", Section::Arch}},
              "Shape of the cross-section; an arch is a semicircle on upright walls.")
      .integer("lanes", &Roadway::lanes, between(1, 2), "Number of lanes.")
      .choice("traffic", &Roadway::traffic,
              {{"both_ways", Traffic::BothWays},
               {"forward_only", Traffic::ForwardOnly},
               {"backward_only", Traffic::BackwardOnly}},
              "Which way vehicles may drive, along growing chainage being forward.")
      .number("speed_limit_m_per_s", &Roadway::speed_limit, moreThan(0), "Speed limit.")
      .flag("locked", &Roadway::locked, "Whether vehicles need a lock for its intervals.")
      .number("chainage_start_m", &Roadway::chainage_start, anything(), "Chainage of the first point.")
      .list("centreline", &Roadway::centreline, pointOptions(),
            "Surveyed points; chainage is the length in space along them.")
      .required();
}

OptionTable<Junction> junctionOptions() {
  return OptionTable<Junction>("junctions", "Where roadways meet on one level.")
      .text("id", &Junction::id, "Id that stays the same from version to version.")
      .required()
      .text("name", &Junction::name, "Name on drawings and in messages.")
      .list("places", &Junction::places, placeOptions("places", "A roadway that is joined here."),
            "The roadways joined, at an end or anywhere along them.")
      .required();
}

OptionTable<Crossing> crossingOptions() {
  return OptionTable<Crossing>("crossings", "Where a roadway passes above another without meeting it.")
      .text("id", &Crossing::id, "Id that stays the same from version to version.")
      .required()
      .table("upper", &Crossing::upper, placeOptions("upper", "Place on the upper roadway."),
             "Place on the upper roadway.")
      .required()
      .table("lower", &Crossing::lower, placeOptions("lower", "Place on the lower roadway."),
             "Place on the lower roadway.")
      .required();
}

OptionTable<Bend> bendOptions() {
  return OptionTable<Bend>("bends", "A bend, which ends one straight leg and begins the next.")
      .text("id", &Bend::id, "Id that stays the same from version to version.")
      .required()
      .text("name", &Bend::name, "Name on drawings and in messages.")
      .text(
          "roadway", [](auto& bend) -> auto& { return bend.stretch.roadway; }, "Id of the roadway.")
      .required()
      .number(
          "from_m", [](auto& bend) -> auto& { return bend.stretch.from; }, anything(),
          "Chainage where it begins.")
      .required()
      .number(
          "to_m", [](auto& bend) -> auto& { return bend.stretch.to; }, anything(), "Chainage where it ends.")
      .required();
}

OptionTable<Route> routeOptions() {
  return OptionTable<Route>("routes", "A transport route.")
      .text("id", &Route::id, "Id that stays the same from version to version.")
      .required()
      .text("name", &Route::name, "Name on drawings and in messages.")
      .list("legs", &Route::legs, legOptions(), "Its parts in driving order.")
      .required();
}

}  // namespace pos::io
