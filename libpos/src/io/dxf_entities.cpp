// Records read as entities.
#include <cmath>

#include "dxf_records.hpp"
#include "pos/core/angle.hpp"

namespace pos::io::dxf {
namespace {

constexpr const char* kTilted = "drawn on a tilted plane";

/// How the entity's own plane lies in the drawing (DXF's "arbitrary axis algorithm").
enum class Plane { Up, Down, Tilted };

Plane planeOf(Numbers& number) {
  const Eigen::Vector3d normal(number(210, 0.0), number(220, 0.0), number(230, 1.0));
  if (!(std::hypot(normal.x(), normal.y()) <= 1e-9 * std::abs(normal.z()))) return Plane::Tilted;
  return normal.z() > 0.0 ? Plane::Up : Plane::Down;
}

/// What became of a record.
struct Outcome {
  std::optional<DxfEntity> entity = {};
  std::string reason = {};  ///< why there is none
};

Outcome refused(std::string reason) {
  return {std::nullopt, std::move(reason)};
}

/// The entity with its plane applied: seen from below, x and z change their signs and arcs turn round.
Outcome finished(DxfEntity entity, Numbers& number, Plane plane) {
  if (!number.trouble().empty()) return refused(number.trouble());
  if (plane == Plane::Tilted) return refused(kTilted);
  if (plane == Plane::Down) {
    for (DxfVertex& vertex : entity.vertices) {
      vertex.p.x() = -vertex.p.x();
      vertex.p.z() = -vertex.p.z();
      vertex.bulge = -vertex.bulge;
    }
  }
  return {std::move(entity), {}};
}

Outcome line(const Record& record, DxfEntity entity) {
  Numbers number(record);
  const Eigen::Vector3d from = number.point();
  const Eigen::Vector3d to(number.need(11), number.need(21), number(31, 0.0));
  entity.vertices = {{from, 0.0}, {to, 0.0}};
  return finished(std::move(entity), number, Plane::Up);  // LINE is in world coordinates whatever its normal
}

Outcome arc(const Record& record, DxfEntity entity) {
  Numbers number(record);
  const Eigen::Vector3d centre = number.point();
  const double radius = number.need(40);
  const double start = radians(number.need(50));
  const double swept_deg = std::fmod(std::fmod(number.need(51) - degrees(start), 360.0) + 360.0, 360.0);
  if (number.trouble().empty() && (!(radius > 0.0) || !(swept_deg > 1e-9))) return refused("without length");
  const double swept = radians(swept_deg);
  const auto at = [&](double angle) -> Eigen::Vector3d {
    return centre + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
  };
  const double bulge = std::tan(swept / 8.0);  // two halves: an arc may go almost round
  entity.vertices = {{at(start), bulge}, {at(start + 0.5 * swept), bulge}, {at(start + swept), 0.0}};
  return finished(std::move(entity), number, planeOf(number));
}

Outcome place(const Record& record, DxfEntity entity, DxfEntity::Kind kind) {
  Numbers number(record);
  entity.kind = kind;
  entity.vertices = {{number.point(), 0.0}};
  if (kind == DxfEntity::Kind::Circle) entity.radius = number.need(40);
  entity.text = plainText(record.text(1));
  return finished(std::move(entity), number, kind == DxfEntity::Kind::Point ? Plane::Up : planeOf(number));
}

Outcome withLength(Outcome outcome) {
  if (outcome.entity && outcome.entity->vertices.size() < 2) return refused("fewer than two points");
  return outcome;
}

Outcome lightPolyline(const Record& record, DxfEntity entity) {
  Numbers number(record);
  const double elevation = number(38, 0.0);
  entity.closed = (number.whole(70, 0) & 1) != 0;
  bool has_y = true;
  for (const Group& group : record.groups) {
    if (group.code == 10) {
      if (!has_y) return refused("damaged: a point without y");
      entity.vertices.push_back({{number.checked(group.value, 10), 0.0, elevation}, 0.0});
      has_y = false;
    }
    if (entity.vertices.empty()) continue;
    if (group.code == 20) {
      entity.vertices.back().p.y() = number.checked(group.value, 20);
      has_y = true;
    }
    if (group.code == 42) entity.vertices.back().bulge = number.checked(group.value, 42);
  }
  if (!has_y) return refused("damaged: a point without y");
  return withLength(finished(std::move(entity), number, planeOf(number)));
}

/// The records that follow a POLYLINE or INSERT up to its SEQEND; `at` is left on the last of them.
std::vector<const Record*> followers(const std::vector<Record>& records, std::size_t& at,
                                     std::string_view type) {
  std::vector<const Record*> found;
  while (at + 1 < records.size() && records[at + 1].type == type) found.push_back(&records[++at]);
  if (at + 1 < records.size() && records[at + 1].type == "SEQEND") ++at;
  return found;
}

Outcome polyline(const Record& record, DxfEntity entity, const std::vector<const Record*>& vertices) {
  Numbers number(record);
  const int flags = number.whole(70, 0);
  if ((flags & (16 | 64)) != 0) return refused("a mesh");
  const bool spatial = (flags & 8) != 0;
  const double elevation = number(30, 0.0);
  entity.closed = (flags & 1) != 0;
  for (const Record* vertex : vertices) {
    Numbers own(*vertex);
    if ((own.whole(70, 0) & 16) != 0) continue;  // a control point of a spline, not on the curve
    Eigen::Vector3d p = own.point();
    if (!spatial) p.z() = elevation;
    entity.vertices.push_back({p, spatial ? 0.0 : own(42, 0.0)});
    if (!own.trouble().empty()) return refused(own.trouble());
  }
  return withLength(finished(std::move(entity), number, spatial ? Plane::Up : planeOf(number)));
}

struct InsertOutcome {
  std::optional<Insert> insert = {};
  std::string reason = {};
};

InsertOutcome insertion(const Record& record, DxfEntity entity,
                        const std::vector<const Record*>& attributes) {
  Numbers number(record);
  Insert insert;
  entity.kind = DxfEntity::Kind::Symbol;
  entity.block = std::string(record.text(2));
  entity.vertices = {{number.point(), 0.0}};
  for (const Record* attribute : attributes) {
    const std::string value = plainText(attribute->text(1));
    if (!value.empty()) entity.text += (entity.text.empty() ? "" : " ") + value;
  }
  insert.scale = {number(41, 1.0), number(42, 1.0), number(43, 1.0)};
  insert.rotation = radians(number(50, 0.0));
  insert.columns = std::max(1, number.whole(70, 1));
  insert.rows = std::max(1, number.whole(71, 1));
  insert.column_step = number(44, 0.0);
  insert.row_step = number(45, 0.0);
  const Plane plane = planeOf(number);
  insert.mirrored = plane == Plane::Down;
  if (!number.trouble().empty()) return {std::nullopt, number.trouble()};
  if (plane == Plane::Tilted) return {std::nullopt, kTilted};
  if (insert.scale.x() == 0.0 || insert.scale.y() == 0.0) return {std::nullopt, "scaled to nothing"};
  insert.symbol = std::move(entity);
  return {std::move(insert), {}};
}

Outcome entityOf(const std::vector<Record>& records, std::size_t& at, DxfEntity start) {
  using Kind = DxfEntity::Kind;
  const Record& record = records[at];
  if (record.type == "LINE") return line(record, std::move(start));
  if (record.type == "ARC") return arc(record, std::move(start));
  if (record.type == "CIRCLE") return place(record, std::move(start), Kind::Circle);
  if (record.type == "POINT") return place(record, std::move(start), Kind::Point);
  if (record.type == "TEXT") return place(record, std::move(start), Kind::Text);
  if (record.type == "LWPOLYLINE") return lightPolyline(record, std::move(start));
  if (record.type == "POLYLINE") return polyline(record, std::move(start), followers(records, at, "VERTEX"));
  const bool curve = record.type == "SPLINE" || record.type == "ELLIPSE" || record.type == "MLINE";
  return refused(curve ? "not read: convert it to polylines in the drawing program" : "not read");
}

}  // namespace

Content contentOf(const std::vector<Record>& records, std::size_t& at, std::string_view end,
                  SkipList& skipped) {
  Content content;
  for (; at < records.size() && records[at].type != end && records[at].type != "ENDSEC"; ++at) {
    const Record& record = records[at];
    DxfEntity start;
    start.type = plainText(record.type);
    start.layer = plainText(record.text(8));
    start.line = record.line;
    if (start.layer.empty()) start.layer = "0";
    const std::string layer = start.layer;
    Numbers number(record);
    std::string reason = number.whole(67, 0) == 1 ? "on a layout sheet" : "";
    if (record.type == "INSERT") {
      auto outcome = insertion(
          record, std::move(start),
          number.whole(66, 0) == 1 ? followers(records, at, "ATTRIB") : std::vector<const Record*>{});
      if (outcome.insert && reason.empty())
        content.inserts.emplace_back(content.entities.size(), *outcome.insert);
      if (reason.empty()) reason = outcome.reason;
    } else {
      Outcome outcome = entityOf(records, at, std::move(start));
      if (outcome.entity && reason.empty()) content.entities.push_back(std::move(*outcome.entity));
      if (reason.empty()) reason = outcome.reason;
    }
    if (!reason.empty()) skipped.add(layer, record.type, reason, record.line);
  }
  return content;
}

}  // namespace pos::io::dxf
