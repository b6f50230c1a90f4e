#pragma once
/// What imports of plans and tables have in common. Internal to io.

#include <set>
#include <string>
#include <vector>

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

/// Junctions where a roadway ends within `reach` (m, in plan) of another one on the same level (within 1 m of
/// height). A place within `reach` of a roadway's end is that end.
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
std::optional<NearestPlace> nearestRoadway(const std::vector<map::Roadway>& roadways,
                                           const Eigen::Vector3d& p_map, double reach, double level);

}  // namespace pos::io
