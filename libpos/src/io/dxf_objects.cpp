// Names, places and sizes of the objects of a drawing, and the count of its entities.
#include <algorithm>
#include <cmath>

#include "dxf_parts.hpp"
#include "pos/io/text.hpp"
#include "pos/map/centreline.hpp"

namespace pos::io::dxf {

bool isChamber(DxfLayerKind kind) {
  return kind == DxfLayerKind::PassingChamber || kind == DxfLayerKind::RefugeChamber;
}

std::string nameOf(DxfLayerKind kind) {
  switch (kind) {
    case DxfLayerKind::Roadway:
      return "roadway";
    case DxfLayerKind::Anchor:
      return "anchor";
    case DxfLayerKind::Portal:
      return "portal";
    default:
      return isChamber(kind) ? "chamber" : "ignored";
  }
}

std::string idFrom(const std::string& label) {
  std::string id = label;
  std::replace(id.begin(), id.end(), ' ', '_');
  return id;
}

std::optional<AnchorId> lastNumber(const std::string& label) {
  const std::size_t end = label.find_last_of("0123456789");
  if (end == std::string::npos) return std::nullopt;
  std::size_t begin = end;
  while (begin > 0 && label[begin - 1] >= '0' && label[begin - 1] <= '9') --begin;
  const auto number = text::integer(std::string_view(label).substr(begin, end + 1 - begin));
  if (!number || *number > 2'000'000'000) return std::nullopt;
  return static_cast<AnchorId>(*number);
}

Eigen::Vector3d middleOf(const std::vector<DxfVertex>& vertices) {
  Eigen::Vector3d low = vertices.front().p;
  Eigen::Vector3d high = low;
  for (const DxfVertex& vertex : vertices) {
    low = low.cwiseMin(vertex.p);
    high = high.cwiseMax(vertex.p);
  }
  return 0.5 * (low + high);
}

map::Chamber measured(map::Chamber chamber, const std::vector<DxfVertex>& vertices,
                      const map::Roadway& roadway) {
  const map::Centreline line(roadway);
  double from = 1e300, to = -1e300, farthest = 0.0;
  for (const DxfVertex& vertex : vertices) {
    const map::Centreline::Foot foot = line.foot(vertex.p);
    from = std::min(from, foot.chainage);
    to = std::max(to, foot.chainage);
    farthest = std::max(farthest, std::abs(foot.offset));
  }
  chamber.place.chainage = 0.5 * (from + to);
  chamber.length = to - from;
  chamber.depth = std::max(0.0, farthest - 0.5 * roadway.width);
  return chamber;
}

void Ledger::add(const std::string& layer, const std::string& type, const std::string& what,
                 std::size_t count, bool used) {
  DxfCount& entry = found_[layer + '\n' + type + '\n' + what + (used ? "\n1" : "\n0")];
  entry = {layer, type, what, entry.count + count, used};
}

std::vector<DxfCount> Ledger::list() const {
  std::vector<DxfCount> all;
  for (const auto& [key, entry] : found_) all.push_back(entry);
  return all;
}

}  // namespace pos::io::dxf
