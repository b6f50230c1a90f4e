#pragma once
/// A packed tree of boxes that never changes: median splits along the longest axis, a few boxes a leaf.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace pos::map {

using Box = Eigen::AlignedBox3d;

class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<Box>& boxes);

  /// `visit(i)` for every box that touches `box`.
  template <class Visit>
  void touching(const Box& box, Visit&& visit) const {
    descend([&](const Box& node) { return node.intersects(box); }, visit);
  }

  /// `visit(i)` for every box that the straight line from `a` to `b` may touch when grown by `margin` (m).
  template <class Visit>
  void along(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double margin, Visit&& visit) const {
    const Eigen::Vector3d middle = 0.5 * (a + b);
    const Eigen::Vector3d half = 0.5 * (b - a);
    const Eigen::Vector3d reach = half.cwiseAbs();
    descend([&](const Box& node) { return touchesLine(node, middle, half, reach, margin); }, visit);
  }

  /// `visit(i)` returns the distance that is still of interest; boxes farther than that from `p` are left
  /// out.
  template <class Visit>
  void nearest(const Eigen::Vector3d& p, Visit&& visit) const {
    if (nodes_.empty()) return;
    double limit = std::numeric_limits<double>::infinity();
    std::array<std::uint32_t, kDepth> open{};
    std::size_t count = 0;
    open[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[open[--count]];
      if (node.box.squaredExteriorDistance(p) > limit * limit) continue;
      if (node.count > 0) {
        for (std::uint32_t i = 0; i < node.count; ++i) {
          if (boxes_[node.first + i].squaredExteriorDistance(p) <= limit * limit)
            limit = visit(items_[node.first + i]);
        }
        continue;
      }
      const bool left_first = nodes_[node.first].box.squaredExteriorDistance(p) <=
                              nodes_[node.first + 1].box.squaredExteriorDistance(p);
      open[count++] = left_first ? node.first + 1 : node.first;
      open[count++] = left_first ? node.first : node.first + 1;
    }
  }

 private:
  static constexpr std::size_t kDepth = 64;
  struct Node {
    Box box = {};
    std::uint32_t first = 0;  ///< leaf: first box; else: first of two child nodes
    std::uint32_t count = 0;  ///< boxes of a leaf, 0 for a branch
  };

  /// Separating axes: the three of the box and the three products of the line with them.
  static bool touchesLine(const Box& box, const Eigen::Vector3d& middle, const Eigen::Vector3d& half,
                          const Eigen::Vector3d& reach, double margin) {
    const Eigen::Vector3d d = middle - box.center();
    const Eigen::Vector3d e = 0.5 * box.sizes() + Eigen::Vector3d::Constant(margin);
    if (((d.cwiseAbs() - e - reach).array() > 0.0).any()) return false;
    return std::abs(d.y() * half.z() - d.z() * half.y()) <= e.y() * reach.z() + e.z() * reach.y() + 1e-9 &&
           std::abs(d.z() * half.x() - d.x() * half.z()) <= e.x() * reach.z() + e.z() * reach.x() + 1e-9 &&
           std::abs(d.x() * half.y() - d.y() * half.x()) <= e.x() * reach.y() + e.y() * reach.x() + 1e-9;
  }

  template <class Touches, class Visit>
  void descend(const Touches& touches, Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, kDepth> open{};
    std::size_t count = 0;
    open[count++] = 0;
    while (count > 0) {
      const Node& node = nodes_[open[--count]];
      if (!touches(node.box)) continue;
      if (node.count == 0) {
        open[count++] = node.first + 1;
        open[count++] = node.first;
        continue;
      }
      for (std::uint32_t i = 0; i < node.count; ++i) {
        if (touches(boxes_[node.first + i])) visit(items_[node.first + i]);
      }
    }
  }

  void build(std::size_t node, std::uint32_t first, std::uint32_t last);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;  ///< indices of the caller, in tree order
  std::vector<Box> boxes_;            ///< the same order as items_
};

}  // namespace pos::map
