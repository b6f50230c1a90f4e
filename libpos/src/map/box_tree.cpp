#include "box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace pos::map {
namespace {

constexpr std::uint32_t kLeafSize = 4;

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) : items_(boxes.size()), boxes_(boxes) {
  if (boxes.empty()) return;
  std::iota(items_.begin(), items_.end(), 0U);
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(boxes.size()));
  for (std::size_t i = 0; i < items_.size(); ++i) boxes_[i] = boxes[items_[i]];
}

/// While the tree is built, boxes_ is still in the caller's order.
void BoxTree::build(std::size_t node, std::uint32_t first, std::uint32_t last) {
  Box all;
  Box centres;
  for (std::uint32_t i = first; i < last; ++i) {
    all.extend(boxes_[items_[i]]);
    centres.extend(boxes_[items_[i]].center());
  }
  nodes_[node].box = all;
  if (last - first <= kLeafSize) {
    nodes_[node].first = first;
    nodes_[node].count = last - first;
    return;
  }
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::uint32_t middle = first + (last - first) / 2;
  const auto begin = items_.begin();
  std::nth_element(begin + first, begin + middle, begin + last, [&](std::uint32_t a, std::uint32_t b) {
    return boxes_[a].center()[axis] < boxes_[b].center()[axis];
  });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = child;
  nodes_.resize(nodes_.size() + 2);
  build(child, first, middle);
  build(child + 1, middle, last);
}

}  // namespace pos::map
