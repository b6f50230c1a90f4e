#pragma once
/// The centreline of a roadway as lines and arcs with even grade between surveyed points.

#include <vector>

#include "pos/map/roadway.hpp"

namespace pos::map {

/// One line or arc. In plan, position(u) for u in [0, plan_length] starts at `start` with heading `heading`
/// and turns by `curvature` per metre; the height rises by `grade` per metre of plan.
struct CentrelineSegment {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  double heading = 0.0;      ///< rad, at the start
  double curvature = 0.0;    ///< 1/m, positive to the left
  double plan_length = 0.0;  ///< m
  double grade = 0.0;        ///< rise per metre of plan
  double chainage = 0.0;     ///< m, at the start
  double length = 0.0;       ///< m, in space

  Eigen::Vector2d planAt(double u) const;
  double headingAt(double u) const { return heading + curvature * u; }
  Eigen::Vector3d endPoint() const;
};

/// Where a centreline is at some chainage.
struct CentrelineState {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  double heading = 0.0;    ///< rad, of growing chainage, counter-clockwise from the map's x axis
  double grade = 0.0;      ///< rad, rising positive
  double curvature = 0.0;  ///< 1/m in plan, positive to the left
};

/// The point of a segment nearest in plan.
struct SegmentFoot {
  double u = 0.0;       ///< m in plan from the segment's start
  double beyond = 0.0;  ///< m, how far the point lies past the segment's nearer end, along it
  double offset = 0.0;  ///< m, positive to the left
  double height = 0.0;  ///< m above the floor
};
SegmentFoot footOn(const CentrelineSegment& segment, const Eigen::Vector3d& p_map);

class Centreline {
 public:
  /// Throws ConfigError for fewer than two points, for a number that is none and for points without distance
  /// in plan (vertical shafts are not roadways).
  explicit Centreline(const Roadway& roadway);

  const std::vector<CentrelineSegment>& segments() const { return segments_; }
  double chainageStart() const { return start_; }
  double chainageEnd() const { return end_; }
  double length() const { return end_ - start_; }

  /// Past an end the centreline continues straight.
  CentrelineState at(double chainage) const;
  /// The segment that holds this chainage; the first or last one past an end.
  std::size_t segmentAt(double chainage) const;

  /// Where a point lies as seen from the centreline.
  struct Foot {
    double chainage = 0.0;  ///< m, of the point of the centreline that is nearest in plan
    double offset = 0.0;    ///< m, positive to the left; at a kink the whole distance in plan
    double height = 0.0;    ///< m, above the floor there
    double beyond = 0.0;    ///< m, along the tangent past the first or last point
  };
  Foot foot(const Eigen::Vector3d& p_map) const;
  /// As seen from one of the segments.
  Foot footOnSegment(std::size_t segment, const Eigen::Vector3d& p_map) const;

 private:
  std::vector<CentrelineSegment> segments_;
  double start_ = 0.0;
  double end_ = 0.0;
};

}  // namespace pos::map
