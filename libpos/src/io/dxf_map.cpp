#include "pos/io/dxf_map.hpp"

#include <algorithm>
#include <cmath>

#include "dxf_parts.hpp"
#include "map_assembly.hpp"
#include "pos/core/error.hpp"
#include "pos/io/text.hpp"
#include "pos/map/centreline.hpp"

namespace pos::io {
namespace {

using namespace dxf;
using Kind = DxfEntity::Kind;

/// An object to be, with the text that names it.
struct Named {
  std::vector<DxfVertex> vertices = {};
  std::vector<const DxfEntity*> entities = {};
  DxfLayerKind kind = DxfLayerKind::Ignore;
  std::string label = {};
  double label_distance = 1e300;
  PlanBox box = {};
};

bool isPlace(const DxfEntity& entity) {
  return entity.kind == Kind::Point || entity.kind == Kind::Circle || entity.kind == Kind::Symbol;
}

class Import {
 public:
  Import(const DxfDrawing& drawing, const DxfImportRules& rules)
      : drawing_(drawing), rules_(rules), layers_(drawing, rules.layers), unit_(unit()) {}

  DxfImport run() {
    sortShapes();
    nameObjects();
    result_.map.mine_grid = rules_.mine_grid;
    makeRoadways();
    for (const Named& object : objects_) {
      if (object.kind == DxfLayerKind::Anchor) makeAnchor(object);
      if (isChamber(object.kind)) makeChamber(object);
      if (object.kind == DxfLayerKind::Portal) makePortal(object);
    }
    for (const DxfSkipped& skip : drawing_.skipped)
      ledger_.add(skip.layer, skip.type, skip.reason, skip.count, false);
    result_.counts = ledger_.list();
    requireContent();
    if (!drawing_.complete)
      result_.remarks.push_back("the drawing ends without EOF; it may have been cut short");
    return std::move(result_);
  }

 private:
  double unit() const {
    if (rules_.metres_per_unit) return *rules_.metres_per_unit;
    if (drawing_.metres_per_unit) return *drawing_.metres_per_unit;
    throw ConfigError(Complaint{.what = "the drawing does not say in which unit it is",
                                .place = {.file = drawing_.file},
                                .key = "$INSUNITS",
                                .suggestion = "say it: --units m, mm, cm, km, in or ft"});
  }

  /// The shape in map coordinates.
  Shape shapeOf(const DxfEntity& entity, DxfLayerKind kind) const {
    Shape shape{&entity, kind, entity.vertices};
    for (DxfVertex& vertex : shape.vertices) {
      vertex.p *= unit_;
      if (rules_.mine_grid) vertex.p = map::fromGrid(*rules_.mine_grid, vertex.p);
    }
    return shape;
  }

  void sortShapes() {
    std::vector<Shape> paths;
    for (const DxfEntity& entity : drawing_.entities) {
      const auto kind = layers_.kindOf(entity.layer);
      if (!kind || *kind == DxfLayerKind::Ignore) {
        ledger_.left(entity, kind ? "layer ignored" : "layer not mapped");
        continue;
      }
      const Shape shape = shapeOf(entity, *kind);
      for (const DxfVertex& vertex : shape.vertices) points_.push_back(vertex.p);
      if (entity.kind == Kind::Text) {
        texts_.push_back(shape);
      } else if (*kind == DxfLayerKind::Roadway) {
        sortRoadwayShape(shape, paths);
      } else if (entity.block_part) {
        ledger_.used(entity, "part of a symbol");
      } else if (isPlace(entity) || isChamber(*kind)) {
        objects_.push_back(
            {shape.vertices, {&entity}, *kind, entity.text, entity.text.empty() ? 1e300 : 0.0});
      } else {
        ledger_.left(entity, "a line is no " + nameOf(*kind));
      }
    }
    requireLocal(points_, drawing_.file);
    for (Chain& chain : joined(paths, rules_.join)) {
      objects_.push_back(
          {std::move(chain.vertices), std::move(chain.entities), DxfLayerKind::Roadway, {}, 1e300});
    }
    std::stable_sort(objects_.begin(), objects_.end(), [](const Named& a, const Named& b) {
      return a.entities.front()->line < b.entities.front()->line;
    });
  }

  void sortRoadwayShape(const Shape& shape, std::vector<Shape>& paths) {
    if (shape.entity->kind == Kind::Path) {
      paths.push_back(shape);
    } else if (shape.entity->kind == Kind::Symbol) {
      ledger_.used(*shape.entity, "block, its lines were read");
    } else {
      ledger_.left(*shape.entity, "no line of a roadway");
    }
  }

  /// Every text goes to the nearest object of its kind; an object keeps the nearest of its texts.
  void nameObjects() {
    for (Named& object : objects_) object.box = boxOf(object.vertices);
    for (const Shape& text : texts_) {
      Named* nearest = nullptr;
      double least = rules_.label_distance;
      for (Named& object : objects_) {
        if (object.kind != text.kind || object.box.distance(text.vertices.front().p.head<2>()) > least)
          continue;
        const double distance = distanceTo(object.vertices, text.vertices.front().p);
        if (distance > least) continue;
        least = distance;
        nearest = &object;
      }
      if (nearest == nullptr || text.entity->text.empty()) {
        ledger_.left(*text.entity, nearest ? "empty" : "a text with nothing near to name");
        continue;
      }
      ledger_.used(*text.entity, "name");
      if (least >= nearest->label_distance) continue;
      nearest->label = text.entity->text;
      nearest->label_distance = least;
    }
  }

  void makeRoadways() {
    std::size_t dropped = 0;
    std::set<std::string> drawn;
    FreshIds ids;
    std::vector<std::pair<const Named*, std::vector<map::CentrelinePoint>>> made;
    for (const Named& object : objects_) {
      if (object.kind != DxfLayerKind::Roadway) continue;
      CentrelineMade line = centrelineOf(object.vertices);
      dropped += line.dropped;
      const bool good = line.points.size() > 1;
      const bool fresh = good && drawn.insert(shapeKey(line.points)).second;
      for (const DxfEntity* entity : object.entities) {
        if (fresh) {
          ledger_.used(*entity, "roadway");
        } else {
          ledger_.left(*entity, good ? "drawn twice" : "without length in plan");
        }
      }
      if (!fresh) continue;
      made.emplace_back(&object, std::move(line.points));
    }
    std::vector<std::string> taken(made.size());
    for (std::size_t i = 0; i < made.size(); ++i) {
      if (!made[i].first->label.empty()) taken[i] = ids.take(idFrom(made[i].first->label));
    }
    int number = 1;
    for (std::size_t i = 0; i < made.size(); ++i) {
      while (taken[i].empty() && ids.taken("R" + std::to_string(number))) ++number;
      if (taken[i].empty()) taken[i] = ids.take("R" + std::to_string(number));
      map::Roadway roadway = rules_.roadway;
      roadway.id = taken[i];
      if (made[i].first->label != roadway.id) roadway.name = made[i].first->label;
      roadway.centreline = std::move(made[i].second);
      result_.map.roadways.push_back(std::move(roadway));
    }
    if (dropped > 0)
      result_.remarks.push_back(std::to_string(dropped) + " points on top of the one before were dropped");
    result_.map.junctions = junctionsFound(result_.map.roadways, rules_.junction_reach);
    lines_.emplace(result_.map.roadways);
  }

  /// The last number in the label, or the next free one.
  AnchorId anchorId(const std::string& label) {
    const auto number = lastNumber(label);
    if (number && anchor_ids_.insert(*number).second) return *number;
    const AnchorId next = anchor_ids_.empty() ? 1 : *anchor_ids_.rbegin() + 1;
    anchor_ids_.insert(next);
    result_.remarks.push_back("anchor " + (label.empty() ? "without a name" : "'" + label + "'") +
                              " has no number of its own and became id " + std::to_string(next));
    return next;
  }

  void makeAnchor(const Named& object) {
    map::Anchor anchor;
    anchor.id = anchorId(object.label);
    anchor.name = object.label.empty() ? std::to_string(anchor.id) : object.label;
    anchor.p_map = object.vertices.front().p;
    result_.map.anchors.push_back(anchor);
    ledger_.used(*object.entities.front(), "anchor");
  }

  std::optional<NearestPlace> placeOf(const Named& object) {
    const auto place = nearestRoadway(*lines_, middleOf(object.vertices), rules_.roadway_near, 10.0);
    if (!place) ledger_.left(*object.entities.front(), "no roadway near this " + nameOf(object.kind));
    return place;
  }

  void makeChamber(const Named& object) {
    const auto near = placeOf(object);
    if (!near) return;
    const map::Roadway& roadway = result_.map.roadways[near->roadway];
    map::Chamber chamber = rules_.chamber;
    chamber.side = near->offset >= 0.0 ? map::Side::Left : map::Side::Right;
    chamber.place = {roadway.id, near->chainage};
    if (object.vertices.size() > 1) chamber = measured(std::move(chamber), object.vertices, roadway);
    chamber.kind =
        object.kind == DxfLayerKind::RefugeChamber ? map::Chamber::Kind::Refuge : map::Chamber::Kind::Passing;
    const std::string wanted =
        object.label.empty() ? "C" + std::to_string(result_.map.chambers.size() + 1) : idFrom(object.label);
    chamber.id = chamber_ids_.take(wanted);
    if (!object.label.empty() && chamber.id != object.label) chamber.name = object.label;
    result_.map.chambers.push_back(std::move(chamber));
    ledger_.used(*object.entities.front(), "chamber");
  }

  void makePortal(const Named& object) {
    const auto near = placeOf(object);
    if (!near) return;
    const map::Roadway& roadway = result_.map.roadways[near->roadway];
    map::Portal portal;
    const std::string wanted =
        object.label.empty() ? "P" + std::to_string(result_.map.portals.size() + 1) : idFrom(object.label);
    portal.id = portal_ids_.take(wanted);
    if (!object.label.empty() && portal.id != object.label) portal.name = object.label;
    portal.place = {roadway.id, near->chainage};
    portal.handover_from = portal.handover_to = near->chainage;
    result_.map.portals.push_back(std::move(portal));
    ledger_.used(*object.entities.front(), "portal");
  }

  void requireContent() const {
    if (!result_.map.roadways.empty() || !result_.map.anchors.empty()) return;
    std::string listed;
    for (const DxfCount& count : result_.counts) {
      listed += (listed.empty() ? "" : "; ") + std::to_string(count.count) + " " + count.type + " on " +
                count.layer + ": " + count.what;
      if (listed.size() > 600) break;
    }
    throw ConfigError(Complaint{.what = "no roadway and no anchor came out of the drawing",
                                .place = {.file = drawing_.file},
                                .got = listed,
                                .suggestion = "map the layers that hold lines: --layer NAME=roadway"});
  }

  const DxfDrawing& drawing_;
  const DxfImportRules& rules_;
  LayerKinds layers_;
  double unit_;
  DxfImport result_;
  Ledger ledger_;
  std::vector<Shape> texts_;
  std::vector<Named> objects_;
  std::vector<Eigen::Vector3d> points_;
  std::optional<RoadwayLines> lines_;
  std::set<AnchorId> anchor_ids_;
  FreshIds chamber_ids_;
  FreshIds portal_ids_;
};

}  // namespace

DxfImport mapFromDxf(const DxfDrawing& drawing, const DxfImportRules& rules) {
  DxfImport result = Import(drawing, rules).run();
  result.map = map::validated(std::move(result.map));
  return result;
}

}  // namespace pos::io
