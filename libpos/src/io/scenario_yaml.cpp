#include "pos/io/scenario_yaml.hpp"

#include "pos/io/files.hpp"
#include "pos/io/overrides.hpp"
#include "scenario_options.hpp"

namespace pos::io {
namespace {

using namespace pos::sim;

OptionTable<EarthConfig> earthOptions() {
  return OptionTable<EarthConfig>("earth", "The Earth as an inertial unit feels it.")
      .choice(
          "kind", &EarthConfig::kind,
          {{"flat", EarthKind::Flat}, {"level", EarthKind::Level}, {"ellipsoid", EarthKind::Ellipsoid}},
          "No rotation; rotation at the latitude of the map's origin; gravity and rotation of WGS84 there.")
      .number("gravity_m_per_s2", &EarthConfig::gravity, between(0, 20), "For flat.");
}

OptionTable<Outline> outlineOptions() {
  constexpr auto self = [](auto& outline) -> auto& {
    return outline;
  };
  return OptionTable<Outline>("open_spaces", "An open space; its outline is rock.")
      .list("outline", self, outlinePointOptions(), "Its corners in order.")
      .required();
}

OptionTable<RockConfig> rockOptions() {
  return OptionTable<RockConfig>("rock", "What stands between tags and anchors.")
      .choice("source", &RockConfig::source,
              {{"none", RockConfig::Source::None},
               {"outlines", RockConfig::Source::Outlines},
               {"roadways", RockConfig::Source::Roadways}},
              "Nothing, the walls of the open spaces listed here, or all rock beside the map's roadways.")
      .list("open_spaces", &RockConfig::open_spaces, outlineOptions(), "Open spaces, for outlines.");
}

OptionTable<SensorEntry> sensorOptions() {
  constexpr auto model = &SensorEntry::model;
  return OptionTable<SensorEntry>("sensors", "One sensor on the vehicle.")
      .text("name", &SensorEntry::name, "Label of its measurements.")
      .required()
      .text("mount", &SensorEntry::mount, "Name of its place on the vehicle, instead of coordinates.")
      .selector("type", "Which kind of sensor; decides which further keys there are.")
      .alternative("imu", model, imuModelOptions(), "Gyros and accelerometers.")
      .alternative("wheels", model, encoderModelOptions(), "Wheel encoders.")
      .alternative("uwb", model, uwbOptions(), "Radio ranges between tags and the map's anchors.")
      .alternative("gnss", model, gnssOptions(), "Satellite fixes; the map needs an origin.")
      .alternative("lidar", model, lidarOptions(), "A laser scanner among the walls of the map's grid.")
      .alternative("support_legs", model, supportLegOptions(),
                   "A laser scanner among the legs of a longwall's supports.")
      .alternative("passages", model, passageOptions(), "Detections of known places.");
}

/// The value of the vehicle file, with what the scenario says of single keys laid over it.
YamlNode laidOver(YamlNode below, const YamlNode& above) {
  if (above.kind != YamlNode::Kind::Table) return below;
  for (std::size_t i = 0; i < above.keys.size(); ++i) {
    if (YamlNode* value = below.find(above.keys[i].name)) {
      *value = above.items[i];
      for (YamlKey& key : below.keys) {
        if (key.name == above.keys[i].name) key.place = above.keys[i].place;
      }
    } else {
      below.keys.push_back(above.keys[i]);
      below.items.push_back(above.items[i]);
    }
  }
  return below;
}

void removeKey(YamlNode& table, const std::string& name) {
  for (std::size_t i = 0; i < table.keys.size(); ++i) {
    if (table.keys[i].name != name) continue;
    table.keys.erase(table.keys.begin() + static_cast<std::ptrdiff_t>(i));
    table.items.erase(table.items.begin() + static_cast<std::ptrdiff_t>(i));
    return;
  }
}

/// A vehicle's own file: `schema: 1` and the keys of `vehicle`.
YamlNode vehicleTable(const std::filesystem::path& file) {
  YamlNode root = loadYaml(file).root;
  if (root.kind != YamlNode::Kind::Table) return root;  // the reader says what is wrong with it
  const YamlNode* schema = root.find("schema");
  if (schema == nullptr || schema->text != "1") {
    throw ConfigError(Complaint{.what = "this is no vehicle file of a known version",
                                .place = schema != nullptr ? schema->place : root.place,
                                .key = "schema",
                                .got = schema != nullptr ? schema->text : "",
                                .expected = "1"});
  }
  removeKey(root, "schema");
  return root;
}

/// The document with the vehicle file read in.
YamlDocument withVehicle(YamlDocument document, const std::filesystem::path& mrpt_share) {
  if (document.root.kind != YamlNode::Kind::Table) return document;
  const YamlNode* named = document.root.find("vehicle_file");
  if (named == nullptr || named->kind != YamlNode::Kind::Scalar) return document;
  const auto path = resolvedPath(named->text, document.file.parent_path(), mrpt_share);
  YamlNode vehicle =
      vehicleTable(existingFile(path, Complaint{.place = named->place, .key = "vehicle_file"}));
  if (YamlNode* own = document.root.find("vehicle")) {
    *own = laidOver(std::move(vehicle), *own);
  } else {
    document.root.add("vehicle", std::move(vehicle));
  }
  removeKey(document.root, "vehicle_file");
  return document;
}

}  // namespace

OptionTable<Scenario> scenarioOptions() {
  return OptionTable<Scenario>("Scenario",
                               "One experiment: what moves how, in which vehicle, with which sensors.")
      .integer("schema", &Scenario::schema, between(1, 1), "Version of this format.")
      .required()
      .text("name", &Scenario::name, "Name of the scenario.")
      .required()
      .text("source", &Scenario::source, "Where it was published: authors, year, section.")
      .text("inferred", &Scenario::inferred, "What the publication does not say and was chosen here.")
      .path("map", &Scenario::map, "The map file: anchors, walls, the tie to the Earth.")
      .path("vehicle_file", &Scenario::vehicle_file, "A vehicle in a file of its own.")
      .table("vehicle", &Scenario::vehicle, vehicleOptions(),
             "The vehicle, or what is different from vehicle_file.")
      .table("earth", &Scenario::earth, earthOptions(), "The Earth as an inertial unit feels it.")
      .table("motion", &Scenario::motion, motionOptions(), "What the vehicle does.")
      .required()
      .number("duration_s", &Scenario::duration, moreThan(0),
              "How long the sensors run; as long as the motion where absent.")
      .number("start_s", &Scenario::start, between(0, 4e9), "Stamp of the start, seconds since 1970 (UTC).")
      .table("rock", &Scenario::rock, rockOptions(), "What stands between tags and anchors.")
      .list("sensors", &Scenario::sensors, sensorOptions(), "The sensors on the vehicle.")
      .required()
      .check([](const Scenario& scenario) { (void)validated(scenario); });
}

Scenario scenarioFrom(const YamlDocument& document, const std::filesystem::path& mrpt_share) {
  const YamlDocument whole = withVehicle(document, mrpt_share);
  Scenario scenario = readOptions(whole, scenarioOptions());
  if (scenario.map) *scenario.map = resolvedPath(*scenario.map, document.file.parent_path(), mrpt_share);
  return scenario;
}

Scenario loadScenario(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                      const std::filesystem::path& mrpt_share) {
  return scenarioFrom(applyOverrides(loadYaml(file), overrides), mrpt_share);
}

std::string resolvedYaml(const Scenario& scenario) {
  return optionsYaml(scenario, scenarioOptions());
}

}  // namespace pos::io
