// Tunnel maps as ASCII DXF R12.
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "pos/core/error.hpp"
#include "pos/io/dxf_map.hpp"
#include "pos/io/text.hpp"
#include "pos/map/network.hpp"
#include "pos/map/outline.hpp"

namespace pos::io {
namespace {

constexpr double kSagitta = 2e-4;  // m, climbing arcs drawn as lines
constexpr double kWallSagitta = 0.01;

struct Layer {
  const char* name;
  int colour;  // AutoCAD colour index
};
constexpr Layer kLayers[] = {{"ROADWAY", 5},  {"WALL", 8},   {"ANCHOR", 1}, {"CHAMBER", 3},  {"REFUGE", 30},
                             {"JUNCTION", 7}, {"PORTAL", 4}, {"LIGHT", 1},  {"STOPLINE", 1}, {"ZONE", 6}};

/// R12 has no Unicode: what is not ASCII is written as \U+XXXX, beyond the first plane as '?'.
std::string dxfText(const std::string& utf8) {
  std::string out;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[i]);
    const std::size_t length = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    if (length == 1) {
      out += lead < 0x20 ? ' ' : utf8[i];
    } else if (length == 4) {
      out += '?';
    } else {
      unsigned code = lead & (length == 2 ? 0x1FU : 0x0FU);
      for (std::size_t k = 1; k < length && i + k < utf8.size(); ++k)
        code = (code << 6U) | (static_cast<unsigned char>(utf8[i + k]) & 0x3FU);
      std::array<char, 16> escape{};
      std::snprintf(escape.data(), escape.size(), "\\U+%04X", code & 0xFFFFU);
      out += escape.data();
    }
    i += length;
  }
  return out;
}

class Writer {
 public:
  Writer(const map::TunnelMap& map, DxfFrame frame)
      : network_(std::make_shared<const map::TunnelMap>(map)), map_(network_.map()), frame_(frame) {}

  std::string text() {
    head();
    for (map::RoadwayIndex i = 0; i < map_.roadways.size(); ++i) roadway(i);
    for (const map::Chamber& chamber : map_.chambers) this->chamber(chamber);
    for (const map::Anchor& anchor : map_.anchors) anchorPoint(anchor);
    for (const map::Junction& junction : map_.junctions) {
      const map::RoadwayPlace& place = junction.places.front();
      mark("JUNCTION", junction.id, at(place));
    }
    for (const map::Portal& portal : map_.portals) mark("PORTAL", portal.id, at(portal.place));
    for (const map::Light& light : map_.lights) {
      const double side = light.side == map::Side::Left ? 0.5 : -0.5;
      mark("LIGHT", light.id, at(light.place, side));
    }
    for (const map::StopLine& stop : map_.stop_lines) stopLine(stop);
    for (const map::RestrictedZone& zone : map_.zones) {
      const map::RoadwayIndex i = network_.indexOf(zone.stretch.roadway);
      const double half = 0.5 * map_.roadways[i].width;
      outline(
          "ZONE", i,
          map::strip(network_.centreline(i), zone.stretch.from, zone.stretch.to, half, -half, kWallSagitta),
          zone.stretch.from);
    }
    return body_ + "  0\nENDSEC\n  0\nEOF\n";
  }

 private:
  void group(int code, const std::string& value) {
    std::array<char, 8> number{};
    std::snprintf(number.data(), number.size(), "%3d", code);
    body_ += number.data();
    body_ += '\n' + value + '\n';
  }
  void group(int code, int value) { group(code, std::to_string(value)); }
  void place(const Eigen::Vector3d& p_map, int first = 10) {
    const Eigen::Vector3d p = frame_ == DxfFrame::MineGrid ? map::toGrid(*map_.mine_grid, p_map) : p_map;
    for (int axis = 0; axis < 3; ++axis) group(first + 10 * axis, text::fixed(p[axis], 6));
  }
  void entity(const char* type, const char* layer) {
    group(0, type);
    group(8, layer);
  }

  void head() {
    group(999, "pos: unit m");
    group(0, "SECTION");
    group(2, "HEADER");
    group(9, "$ACADVER");
    group(1, "AC1009");
    group(0, "ENDSEC");
    group(0, "SECTION");
    group(2, "TABLES");
    table("LTYPE", 1);
    group(0, "LTYPE");
    group(2, "CONTINUOUS");
    group(70, 0);
    group(3, "Solid line");
    group(72, 65);
    group(73, 0);
    group(40, "0.0");
    group(0, "ENDTAB");
    table("LAYER", static_cast<int>(std::size(kLayers)));
    for (const Layer& layer : kLayers) {
      group(0, "LAYER");
      group(2, layer.name);
      group(70, 0);
      group(62, layer.colour);
      group(6, "CONTINUOUS");
    }
    group(0, "ENDTAB");
    group(0, "ENDSEC");
    group(0, "SECTION");
    group(2, "ENTITIES");
  }
  void table(const char* name, int entries) {
    group(0, "TABLE");
    group(2, name);
    group(70, entries);
  }

  void polyline(const char* layer, const std::vector<DxfVertex>& vertices, int flags) {
    const bool spatial = (flags & 8) != 0;
    entity("POLYLINE", layer);
    group(66, 1);
    const double z =
        vertices.front().p.z() + (frame_ == DxfFrame::MineGrid ? map_.mine_grid->elevation : 0.0);
    group(10, "0.0");
    group(20, "0.0");
    group(30, spatial ? "0.0" : text::fixed(z, 6));
    group(70, flags);
    for (const DxfVertex& vertex : vertices) {
      entity("VERTEX", layer);
      place(vertex.p);
      if (spatial) group(70, 32);
      if (vertex.bulge != 0.0) group(42, text::fixed(vertex.bulge, 15));
    }
    entity("SEQEND", layer);
  }
  void outline(const char* layer, std::size_t roadway, const map::PlanLine& polygon, double chainage) {
    std::vector<DxfVertex> vertices;
    const double z = network_.centreline(roadway).at(chainage).p_map.z();
    for (const Eigen::Vector2d& p : polygon) vertices.push_back({{p.x(), p.y(), z}, 0.0});
    polyline(layer, vertices, 1);
  }
  void label(const char* layer, const std::string& text, const Eigen::Vector3d& p) {
    entity("TEXT", layer);
    place(p);
    group(40, "1.5");
    group(1, dxfText(text));
  }
  void mark(const char* layer, const std::string& id, const Eigen::Vector3d& p) {
    entity("POINT", layer);
    place(p);
    label(layer, id, p);
  }

  void roadway(std::size_t i) {
    const map::Roadway& roadway = map_.roadways[i];
    const map::Centreline& line = network_.centreline(i);
    bool level = true;
    for (const auto& point : roadway.centreline)
      level = level && std::abs(point.p_map.z() - roadway.centreline.front().p_map.z()) < 1e-7;
    std::vector<DxfVertex> vertices;
    if (level) {
      for (const auto& point : roadway.centreline)
        vertices.push_back({point.p_map, std::tan(0.25 * point.arc)});
      vertices.back().bulge = 0.0;
    } else {
      for (const double chainage :
           map::sampleChainages(line, line.chainageStart(), line.chainageEnd(), kSagitta))
        vertices.push_back({line.at(chainage).p_map, 0.0});
    }
    polyline("ROADWAY", vertices, level ? 0 : 8);
    label("ROADWAY", roadway.id, line.at(line.chainageStart() + 0.5 * line.length()).p_map);
    const double half = 0.5 * roadway.width;
    outline("WALL", i, map::strip(line, line.chainageStart(), line.chainageEnd(), half, -half, kWallSagitta),
            line.chainageStart());
  }

  void chamber(const map::Chamber& chamber) {
    const map::RoadwayIndex i = network_.indexOf(chamber.place.roadway);
    const char* layer = chamber.kind == map::Chamber::Kind::Refuge ? "REFUGE" : "CHAMBER";
    outline(layer, i, map::chamberOutline(map_.roadways[i], network_.centreline(i), chamber, kWallSagitta),
            chamber.place.chainage);
    const double sign = chamber.side == map::Side::Left ? 1.0 : -1.0;
    const double behind = chamber.depth / map_.roadways[i].width;  // in roadway widths, as at() counts
    label(layer, chamber.id, at(chamber.place, sign * (0.5 + 0.5 * behind)));
  }

  void anchorPoint(const map::Anchor& anchor) { mark("ANCHOR", std::to_string(anchor.id), anchor.p_map); }

  void stopLine(const map::StopLine& stop) {
    entity("LINE", "STOPLINE");
    place(at(stop.place, 0.5));
    place(at(stop.place, -0.5), 11);
  }

  /// The place, moved to the left by a share of the roadway's width.
  Eigen::Vector3d at(const map::RoadwayPlace& place, double share = 0.0) const {
    const map::RoadwayIndex i = network_.indexOf(place.roadway);
    return network_.toMap({i, place.chainage, share * map_.roadways[i].width, 0.0});
  }

  map::Network network_;
  const map::TunnelMap& map_;
  DxfFrame frame_;
  std::string body_;
};

}  // namespace

std::string mapDxf(const map::TunnelMap& map, DxfFrame frame) {
  if (frame == DxfFrame::MineGrid && !map.mine_grid) {
    throw ConfigError(Complaint{.what = "the map has no mine grid to write its coordinates in",
                                .key = "mine_grid",
                                .suggestion = "add mine_grid to the map, or export in the map's own frame"});
  }
  return Writer(map, frame).text();
}

}  // namespace pos::io
