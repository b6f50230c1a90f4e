#include "pos/estimation/uwb_links.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "pos/core/error.hpp"

namespace pos::estimation {
namespace {

constexpr std::uint8_t kRock =
    65;  // percent occupied from which a cell is rock (MRPT's and ROS's usual limit)

/// Even-odd rule, so that any shape of roadway will do.
bool insidePolygon(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Eigen::Vector2d& a = corners[i];
    const Eigen::Vector2d& b = corners[j];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

bool free(const map::OccupancyGrid& grid, const Eigen::Vector2d& p_map) {
  const Eigen::Vector2d p = inverse(grid.T_map_grid) * p_map;
  const int column = static_cast<int>(std::floor((p.x() - grid.x_min) / grid.resolution));
  const int row = static_cast<int>(std::floor((p.y() - grid.y_min) / grid.resolution));
  if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) return false;
  return grid.at(column, row) < kRock;
}

/// The tag at its electrical place.
TagMount shifted(TagMount tag, const std::vector<TagShift>& shifts) {
  for (const TagShift& shift : shifts) {
    if (shift.id == tag.id) tag.p_body += Eigen::Vector3d(shift.x, shift.y, 0.0);
  }
  return tag;
}

}  // namespace

bool RoadwayTest::inside(const Eigen::Vector2d& p_map) const {
  if (!corners_.empty() && !insidePolygon(corners_, p_map)) return false;
  return !map_->grid || free(*map_->grid, p_map);
}

UwbLinks::UwbLinks(const DualUwbConfig& config, const map::TunnelMap& map)
    : config_(config), tags_(config.tags) {
  if (map.anchors.empty()) {
    throw ConfigError(Complaint{.what = "ranges need anchors, and the map has none",
                                .key = "map.anchors",
                                .suggestion = "add the surveyed anchors to the map file"});
  }
  for (const map::Anchor& anchor : map.anchors) {
    index_.emplace(anchor.id, static_cast<int>(anchors_.size()));
    anchors_.push_back({anchor.id, anchor.p_map, std::hypot(config.range_sigma, anchor.survey_sigma), {}});
    map_bias_.push_back(anchor.range_bias + config.range_offset);
  }
  for (TagMount& tag : tags_) tag = shifted(tag, config.tag_shifts);
  for (const LinkBias& link : config.range_biases) {
    if (index_.contains(link.anchor)) continue;
    throw ConfigError(Complaint{.what = "a range bias names an anchor that the map does not have",
                                .key = "range_biases",
                                .got = "anchor " + std::to_string(link.anchor),
                                .suggestion = "calibrate again with this map"});
  }
}

double UwbLinks::biasOf(TagId tag, AnchorId anchor) const {
  for (const LinkBias& link : config_.range_biases) {
    if (link.tag == tag && link.anchor == anchor) return link.bias;
  }
  return 0.0;
}

int UwbLinks::tagIndex(const BeaconRange& range) {
  for (std::size_t i = 0; i < tags_.size(); ++i) {
    if (tags_[i].id == range.tag) return static_cast<int>(i);
  }
  if (!config_.tags.empty() || !range.tag_body) return -1;
  tags_.push_back(shifted({range.tag, *range.tag_body}, config_.tag_shifts));
  return static_cast<int>(tags_.size()) - 1;
}

UwbLookUp UwbLinks::find(const BeaconRange& range) {
  const auto found = index_.find(range.anchor);
  if (found == index_.end()) return {Verdict::Degenerate, "the map has no anchor of this id", {}};
  const int tag = tagIndex(range);
  if (tag < 0) {
    return config_.tags.empty()
               ? UwbLookUp{Verdict::Degenerate, "neither log nor configuration say where the tag sits", {}}
               : UwbLookUp{Verdict::Unsupported, "this tag is not among the configured ones", {}};
  }
  Slot& slot = anchors_[static_cast<std::size_t>(found->second)];
  while (slot.bias.size() < tags_.size()) {  // once for each link
    slot.bias.push_back(map_bias_[static_cast<std::size_t>(found->second)] +
                        biasOf(tags_[slot.bias.size()].id, slot.id));
  }
  const auto t = static_cast<std::size_t>(tag);
  return {
      Verdict::Applied,
      {},
      {tag, found->second, {range.tag, tags_[t].p_body, slot.p_map, range.range - slot.bias[t], slot.sigma}}};
}

}  // namespace pos::estimation
