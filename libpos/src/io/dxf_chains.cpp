// Loose lines joined to chains, and chains made centrelines.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "dxf_parts.hpp"
#include "pos/core/angle.hpp"

namespace pos::io::dxf {
namespace {

constexpr double kSamePoint = 1e-3;  // m in plan; `validated` asks for 1e-4

bool isLoose(const DxfEntity& entity) {
  return entity.type == "LINE" || entity.type == "ARC";
}

std::vector<DxfVertex> reversed(const std::vector<DxfVertex>& vertices) {
  std::vector<DxfVertex> back(vertices.rbegin(), vertices.rend());
  for (std::size_t i = 0; i + 1 < back.size(); ++i) back[i].bulge = -back[i + 1].bulge;
  back.back().bulge = 0.0;
  return back;
}

struct End {
  Eigen::Vector3d p;
  std::size_t path;
  bool first;
};

/// Ends sorted by squares of the plan, so that neighbours are found without comparing all pairs.
class Ends {
 public:
  Ends(const std::vector<const Shape*>& loose, double reach) : reach_(reach) {
    for (std::size_t i = 0; i < loose.size(); ++i) {
      ends_.push_back({squareOf(loose[i]->vertices.front().p), {loose[i]->vertices.front().p, i, true}});
      ends_.push_back({squareOf(loose[i]->vertices.back().p), {loose[i]->vertices.back().p, i, false}});
    }
    std::sort(ends_.begin(), ends_.end(), [](const Placed& a, const Placed& b) {
      return std::tie(a.square, a.end.path, a.end.first) < std::tie(b.square, b.end.path, b.end.first);
    });
  }

  /// The one other end at `p`; nothing when there are none or several.
  const End* partner(const Eigen::Vector3d& p, std::size_t path, bool first) const {
    const Square middle = squareOf(p);
    const End* only = nullptr;
    for (std::int64_t column = middle.first - 1; column <= middle.first + 1; ++column) {
      auto at = std::lower_bound(ends_.begin(), ends_.end(), Square{column, middle.second - 1},
                                 [](const Placed& e, const Square& square) { return e.square < square; });
      for (; at != ends_.end() && at->square <= Square{column, middle.second + 1}; ++at) {
        const End& end = at->end;
        if ((end.path == path && end.first == first) || (end.p - p).norm() > reach_) continue;
        if (only != nullptr) return nullptr;
        only = &end;
      }
    }
    return only;
  }

 private:
  using Square = std::pair<std::int64_t, std::int64_t>;
  struct Placed {
    Square square;
    End end;
  };
  /// As wide as the reach, so that what is within reach lies in the same square or one beside it.
  Square squareOf(const Eigen::Vector3d& p) const {
    const double width = std::max(reach_, kSamePoint);
    return {std::llround(p.x() / width), std::llround(p.y() / width)};
  }

  double reach_;
  std::vector<Placed> ends_;
};

void append(Chain& chain, const Shape& shape, bool forward) {
  std::vector<DxfVertex> more = forward ? shape.vertices : reversed(shape.vertices);
  if (!chain.vertices.empty()) {
    chain.vertices.back().bulge = more.front().bulge;  // the joint is one point
    more.erase(more.begin());
  }
  chain.vertices.insert(chain.vertices.end(), more.begin(), more.end());
  chain.entities.push_back(shape.entity);
}

/// The chain that starts with this end of this path.
Chain followed(const std::vector<const Shape*>& loose, const Ends& ends, std::vector<bool>& taken,
               std::size_t path, bool forward) {
  Chain chain;
  while (true) {
    taken[path] = true;
    append(chain, *loose[path], forward);
    const auto& out = forward ? loose[path]->vertices.back().p : loose[path]->vertices.front().p;
    const End* next = ends.partner(out, path, !forward);
    if (next == nullptr || taken[next->path]) return chain;
    path = next->path;
    forward = next->first;
  }
}

double sweptAngle(double bulge) {
  return 4.0 * std::atan(bulge);
}

/// The middle of the arc between two vertices: beside the chord's middle by half the chord times the bulge,
/// to the right for a counter-clockwise arc.
Eigen::Vector3d middleOfArc(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double bulge) {
  const Eigen::Vector3d chord = b - a;
  return 0.5 * (a + b) + 0.5 * bulge * Eigen::Vector3d(chord.y(), -chord.x(), 0.0);
}

double distanceToLine(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const Eigen::Vector2d d = b - a;
  const double f = d.squaredNorm() > 0.0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - f * d).norm();
}

/// An arc halved so often is a line but for a thousandth of its radius.
constexpr int kArcHalvings = 5;

double distanceToArc(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double bulge,
                     const Eigen::Vector3d& p, int halvings) {
  if (bulge == 0.0 || halvings == 0) return distanceToLine(a.head<2>(), b.head<2>(), p.head<2>());
  const Eigen::Vector3d middle = middleOfArc(a, b, bulge);
  const double half = std::tan(0.5 * std::atan(bulge));
  return std::min(distanceToArc(a, middle, half, p, halvings - 1),
                  distanceToArc(middle, b, half, p, halvings - 1));
}

}  // namespace

std::vector<Chain> joined(const std::vector<Shape>& paths, double reach) {
  std::vector<Chain> chains;
  std::vector<const Shape*> loose;
  for (const Shape& shape : paths) {
    if (isLoose(*shape.entity)) {
      loose.push_back(&shape);
      continue;
    }
    chains.push_back({{shape.entity}, shape.vertices});
    if (shape.entity->closed) {
      chains.back().vertices.push_back(shape.vertices.front());
      chains.back().vertices.back().bulge = 0.0;
    }
  }
  const Ends ends(loose, reach);
  std::vector<bool> taken(loose.size(), false);
  for (const bool rings : {false, true}) {  // open chains from their ends first, then rings
    for (std::size_t i = 0; i < loose.size(); ++i) {
      if (taken[i]) continue;
      const bool start_free = ends.partner(loose[i]->vertices.front().p, i, true) == nullptr;
      const bool end_free = ends.partner(loose[i]->vertices.back().p, i, false) == nullptr;
      if (!rings && !start_free && !end_free) continue;
      chains.push_back(followed(loose, ends, taken, i, rings || start_free));
    }
  }
  return chains;
}

CentrelineMade centrelineOf(const std::vector<DxfVertex>& vertices) {
  CentrelineMade made;
  for (const DxfVertex& vertex : vertices) {
    if (!made.points.empty() && (vertex.p - made.points.back().p_map).head<2>().norm() < kSamePoint) {
      ++made.dropped;
      made.points.back().arc = sweptAngle(vertex.bulge);
      continue;
    }
    if (!made.points.empty() && std::abs(made.points.back().arc) > kPi) {
      const double bulge = std::tan(0.25 * made.points.back().arc);
      const Eigen::Vector3d middle = middleOfArc(made.points.back().p_map, vertex.p, bulge);
      made.points.back().arc *= 0.5;
      made.points.push_back({.p_map = middle, .arc = made.points.back().arc, .station = {}});
    }
    made.points.push_back({.p_map = vertex.p, .arc = sweptAngle(vertex.bulge), .station = {}});
  }
  if (!made.points.empty()) made.points.back().arc = 0.0;
  return made;
}

std::string shapeKey(const std::vector<map::CentrelinePoint>& points) {
  std::string there;
  std::string back;
  const auto rounded = [](double v) { return std::to_string(std::llround(1e3 * v)) + ","; };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const map::CentrelinePoint& last = points[points.size() - 1 - i];
    const double arc_back = i + 1 < points.size() ? -points[points.size() - 2 - i].arc : 0.0;
    const double arc = i + 1 < points.size() ? points[i].arc : 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      there += rounded(points[i].p_map[axis]);
      back += rounded(last.p_map[axis]);
    }
    there += rounded(arc);
    back += rounded(arc_back);
  }
  return std::min(there, back);
}

PlanBox boxOf(const std::vector<DxfVertex>& vertices) {
  PlanBox box;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    box.add(vertices[i].p.head<2>());
    if (vertices[i].bulge == 0.0 || i + 1 == vertices.size()) continue;
    // The circle around the arc's middle that holds both ends holds the arc.
    const Eigen::Vector3d middle = middleOfArc(vertices[i].p, vertices[i + 1].p, vertices[i].bulge);
    const double radius = (vertices[i].p - middle).head<2>().norm();
    box.add(middle.head<2>().array() - radius);
    box.add(middle.head<2>().array() + radius);
  }
  return box;
}

double distanceTo(const std::vector<DxfVertex>& vertices, const Eigen::Vector3d& p) {
  double least = (vertices.front().p - p).head<2>().norm();
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    least =
        std::min(least, distanceToArc(vertices[i].p, vertices[i + 1].p, vertices[i].bulge, p, kArcHalvings));
  }
  return least;
}

}  // namespace pos::io::dxf
