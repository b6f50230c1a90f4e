#pragma once
/// The option tables of a map's parts, in two files to keep each short.

#include "pos/io/options.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::io {

// map_yaml.cpp
OptionTable<map::MineGrid> mineGridOptions();

// map_options_roadways.cpp
OptionTable<map::Roadway> roadwayOptions();
OptionTable<map::Junction> junctionOptions();
OptionTable<map::Crossing> crossingOptions();
OptionTable<map::Bend> bendOptions();
OptionTable<map::Route> routeOptions();

// map_options_furniture.cpp
OptionTable<map::Chamber> chamberOptions();
OptionTable<map::Portal> portalOptions();
OptionTable<map::Light> lightOptions();
OptionTable<map::StopLine> stopLineOptions();
OptionTable<map::RestrictedZone> zoneOptions();
OptionTable<map::Requirements> requirementOptions();
OptionTable<map::BackgroundImage> backgroundOptions();

/// Choices used in several tables.
std::vector<NamedValue<map::Side>> sideNames();
std::vector<NamedValue<map::Direction>> directionNames();

}  // namespace pos::io
