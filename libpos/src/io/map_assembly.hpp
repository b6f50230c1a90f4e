#pragma once
/// What imports of plans and tables have in common. Internal to io.

#include <set>
#include <string>
#include <vector>

#include "pos/map/centreline.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::io {

/// Ids that are each given once.
class FreshIds {
 public:
  /// `wanted` itself, or "wanted_2", "wanted_3" ... where it is taken.
  std::string take(const std::string& wanted);
  bool taken(const std::string& id) const { return taken_.contains(id); }

 private:
  std::set<std::string> taken_;
};

/// A rectangle around a line in plan, m; asked before the line itself.
struct PlanBox {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300);
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-1e300);

  void add(const Eigen::Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  /// 0 inside.
  double distance(const Eigen::Vector2d& p) const {
    return (low - p).cwiseMax(p - high).cwiseMax(0.0).norm();
  }
};

/// Roadways made ready to be asked which one is near.
struct RoadwayLines {
  explicit RoadwayLines(const std::vector<map::Roadway>& roadways);
  std::vector<map::Centreline> lines = {};
  std::vector<PlanBox> boxes = {};  ///< hold the whole arcs
};

/// Junctions where a roadway ends within `reach` (m, in plan) of another one on the same level (within 1 m of
/// height). A place within `reach` of a roadway's end is that end.
/// Throws ConfigError for more than 20 000 roadways.
std::vector<map::Junction> junctionsFound(const std::vector<map::Roadway>& roadways, double reach);

/// Throws ConfigError when the points are those of a mine grid (beyond 1e5 m) and no grid is given.
void requireLocal(const std::vector<Eigen::Vector3d>& points, const std::string& file);

/// The roadway nearest in plan to a point, within `reach` (m) and `level` (m of height); nothing otherwise.
struct NearestPlace {
  std::size_t roadway = 0;
  double chainage = 0.0;
  double offset = 0.0;
  double beyond = 0.0;
};
std::optional<NearestPlace> nearestRoadway(const RoadwayLines& roadways, const Eigen::Vector3d& p_map,
                                           double reach, double level);

}  // namespace pos::io
