#pragma once
/// The roadways of a map made ready for questions: where is this point, and what is inside the rock.

#include <memory>
#include <optional>
#include <vector>

#include "pos/map/centreline.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::map {

/// A point brought to a roadway.
struct Projection {
  TunnelPoint point = {};
  double beyond = 0.0;  ///< m in plan, past the roadway's end; 0 within its length
  double excess = 0.0;  ///< m, from the roadway's cross-section; 0 for a point inside it
};

/// Copying is cheap: the content is shared and never changes. All questions are const and may be asked by
/// several threads.
class Network {
 public:
  /// Throws ConfigError when the map is not usable (`validated`).
  explicit Network(std::shared_ptr<const TunnelMap> map);

  const TunnelMap& map() const;
  const Centreline& centreline(RoadwayIndex roadway) const;
  /// The roadway with this id; throws ConfigError with a suggestion when there is none.
  RoadwayIndex indexOf(const std::string& roadway) const;
  /// Indices into map().chambers of the chambers on this roadway, in map order.
  const std::vector<std::size_t>& chambersOn(RoadwayIndex roadway) const;

  /// The roadway whose cross-section is nearest, so that levels are told apart by height; among several that
  /// hold the point, the one whose centreline is nearest in space. Nothing for a map without roadways.
  /// O(log segments). Exactly undone by `toMap` where `beyond` is 0 and the centreline has no kink there.
  std::optional<Projection> project(const Eigen::Vector3d& p_map) const;

  /// One projection for each roadway whose cross-section is within `radius` (m), nearest first.
  std::vector<Projection> candidates(const Eigen::Vector3d& p_map, double radius) const;

  /// Map coordinates. A chainage past an end continues along the end's tangent.
  Eigen::Vector3d toMap(const TunnelPoint& point) const;

  /// Whether the point is in a roadway (true section shape), a chamber or within `slack` (m) of one. In a map
  /// without roadways nothing is known of rock, and every point is inside and every line in sight.
  bool isInside(const Eigen::Vector3d& p_map, double slack = 0.0) const;

  /// Whether the straight line from `a` to `b` stays in roadways, chambers and a skin of `slack` (m) around
  /// them; an arch counts as its rectangle. A survey leaves wall anchors a few centimetres in the rock.
  bool inSight(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double slack = kWallSlack) const;
  static constexpr double kWallSlack = 0.05;

  /// Indices into map().anchors of the anchors in sight within `range_limit` (m), in map order.
  std::vector<std::size_t> visibleAnchors(const Eigen::Vector3d& p_map, double range_limit,
                                          double slack = kWallSlack) const;

  /// Distance (m) from the point to the nearer side wall of the roadway, negative in the rock.
  double wallDistance(const TunnelPoint& point) const;

 private:
  struct Content;
  std::shared_ptr<const Content> content_;
};

}  // namespace pos::map
