#pragma once
/// Steps from a drawing to a map. Internal to io.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "map_assembly.hpp"
#include "pos/io/dxf_map.hpp"

namespace pos::io::dxf {

/// The rules applied to layer names.
class LayerKinds {
 public:
  /// Throws ConfigError for a rule without a layer and for rules that give no roadway and no anchor.
  LayerKinds(const DxfDrawing& drawing, const std::vector<DxfLayerRule>& rules);
  std::optional<DxfLayerKind> kindOf(const std::string& layer) const;

 private:
  std::vector<DxfLayerRule> rules_;
};

/// An entity in map coordinates on its way into the map.
struct Shape {
  const DxfEntity* entity = nullptr;
  DxfLayerKind kind = DxfLayerKind::Ignore;
  std::vector<DxfVertex> vertices = {};  ///< m
};

/// Every entity gets exactly one line.
class Ledger {
 public:
  void used(const DxfEntity& entity, const std::string& what) {
    add(entity.layer, entity.type, what, 1, true);
  }
  void left(const DxfEntity& entity, const std::string& why) {
    add(entity.layer, entity.type, why, 1, false);
  }
  void add(const std::string& layer, const std::string& type, const std::string& what, std::size_t count,
           bool used);
  std::vector<DxfCount> list() const;

 private:
  std::map<std::string, DxfCount> found_;
};

/// Loose lines and arcs joined end to end where exactly two meet; polylines as they are.
struct Chain {
  std::vector<const DxfEntity*> entities = {};
  std::vector<DxfVertex> vertices = {};
};
std::vector<Chain> joined(const std::vector<Shape>& paths, double reach);

/// The vertices as a surveyed centreline: points on top of each other dropped, arcs beyond a half circle cut
/// in two. Fewer than two points where nothing is left.
struct CentrelineMade {
  std::vector<map::CentrelinePoint> points = {};
  std::size_t dropped = 0;
};
CentrelineMade centrelineOf(const std::vector<DxfVertex>& vertices);

/// The same for two centrelines that are drawn over each other, whichever way, to the millimetre.
std::string shapeKey(const std::vector<map::CentrelinePoint>& points);

/// Holds the whole arcs.
PlanBox boxOf(const std::vector<DxfVertex>& vertices);

/// Distance in plan from a point to a chain of vertices (one or more), m.
double distanceTo(const std::vector<DxfVertex>& vertices, const Eigen::Vector3d& p);

bool isChamber(DxfLayerKind kind);
/// "roadway", "anchor", "chamber", "portal", "ignored".
std::string nameOf(DxfLayerKind kind);
/// An id without blanks.
std::string idFrom(const std::string& label);
/// "UWB-017" -> 17.
std::optional<AnchorId> lastNumber(const std::string& label);
Eigen::Vector3d middleOf(const std::vector<DxfVertex>& vertices);
/// The chamber with place, length along the roadway and depth behind the wall of a drawn outline.
map::Chamber measured(map::Chamber chamber, const std::vector<DxfVertex>& vertices,
                      const map::Roadway& roadway);

}  // namespace pos::io::dxf
