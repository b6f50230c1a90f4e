#pragma once
/// Mine plans in DXF as tunnel maps, and tunnel maps as DXF R12.

#include <optional>
#include <string>
#include <vector>

#include "pos/io/dxf.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// What the shapes on a layer are.
enum class DxfLayerKind { Roadway, Anchor, PassingChamber, RefugeChamber, Portal, Ignore };
/// "roadway", "anchor", "chamber", "refuge", "portal", "ignore"; throws UsageError for another word.
DxfLayerKind dxfLayerKind(const std::string& word);

struct DxfLayerRule {
  std::string pattern = {};  ///< layer name, case ignored; '*' stands for any letters
  DxfLayerKind kind = DxfLayerKind::Ignore;
};
/// "NAME=kind"; throws UsageError.
DxfLayerRule dxfLayerRule(const std::string& text);
/// The layers of our own exports.
std::vector<DxfLayerRule> ownDxfLayers();

struct DxfImportRules {
  std::vector<DxfLayerRule> layers = {};  ///< the first that fits counts; none = those of our own exports
  std::optional<double> metres_per_unit = {};   ///< against what the drawing says
  std::optional<map::MineGrid> mine_grid = {};  ///< the drawing is in this grid
  double join = 0.01;           ///< m, loose lines and arcs whose ends are this near are one roadway
  double label_distance = 5.0;  ///< m, a text this near is an object's name
  double junction_reach = 0.5;  ///< m, a roadway that ends this near another one joins it
  double roadway_near = 30.0;   ///< m, a chamber or portal farther from every roadway is left out
  map::Roadway roadway = {};    ///< width, height, section, lanes for all roadways
  map::Chamber chamber = {.length = 10.0, .depth = 3.0};  ///< size of chambers drawn as a point
};

/// What was made of the entities of one type on one layer.
struct DxfCount {
  std::string layer = {};
  std::string type = {};
  std::string what = {};  ///< "roadway", "name", ..., or why it was left out
  std::size_t count = 0;
  bool used = false;
};

struct DxfImport {
  map::TunnelMap map = {};
  std::vector<DxfCount> counts = {};      ///< by layer, type and use; every entity of the drawing is in one
  std::vector<std::string> remarks = {};  ///< for the surveyor: names given, ids changed, points dropped
};

/// Throws ConfigError: no layer is mapped (names those there are), a rule names no layer, the drawing does
/// not say its unit, its coordinates are those of a mine grid and none is given, no roadway and no anchor
/// came out.
DxfImport mapFromDxf(const DxfDrawing& drawing, const DxfImportRules& rules);

/// Where the written coordinates are.
enum class DxfFrame { Map, MineGrid };

/// ASCII DXF R12 in metres, layers as in ownDxfLayers(). Level roadways are polylines with arcs; where a
/// roadway climbs, its arcs are drawn as short lines (R12 has no climbing arcs) that stay within 0.2 mm.
/// DXF has no room for widths, chainages, rules of traffic and survey data: use GeoJSON to keep everything.
/// Throws ConfigError for DxfFrame::MineGrid without a mine grid.
std::string mapDxf(const map::TunnelMap& map, DxfFrame frame = DxfFrame::Map);

}  // namespace pos::io
