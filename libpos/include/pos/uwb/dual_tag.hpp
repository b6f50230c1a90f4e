#pragma once
/// From two tag positions to the vehicle's pose (spec A, sections 2.4 and 2.5).

#include <Eigen/Core>
#include <optional>

#include "pos/core/belief.hpp"
#include "pos/core/pose2.hpp"

namespace pos::uwb {

/// A tag's place in the map with its covariance, m and m^2.
struct TagPosition {
  Eigen::Vector2d p_map = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// Where the two tags sit on the body (m, FLU). For the paper's vehicle left (0, D/2), right (0, -D/2).
struct TagPair {
  Eigen::Vector2d left_body = Eigen::Vector2d::Zero();
  Eigen::Vector2d right_body = Eigen::Vector2d::Zero();

  Eigen::Vector2d baseline() const { return left_body - right_body; }
  double length() const { return baseline().norm(); }
};

struct SnapshotPose {
  Belief<Pose2> pose;              ///< body origin
  double baseline_chi_square = 0;  ///< (|b| - D)^2 over its variance, one degree of freedom
};

/// The heading that turns the body's baseline onto the measured one, the position that puts the middle
/// of the tags where they were measured. Nothing when the tags were measured at one place.
std::optional<SnapshotPose> snapshotPose(const TagPosition& left, const TagPosition& right,
                                         const TagPair& tags);

/// Motion between two snapshots, map axes.
struct TagAdvance {
  Eigen::Vector2d translation = Eigen::Vector2d::Zero();  ///< m, of the middle of the tags
  double rotation = 0.0;                                  ///< rad, signed, counter-clockwise
};

/// Delta p = mean of the tags' advances, Delta psi = angle from the old baseline to the new one by atan2.
/// (The printed Delta psi = |Delta p| / D is no rotation: errata A4 to A6.)
TagAdvance tagAdvance(const Eigen::Vector2d& left_before, const Eigen::Vector2d& right_before,
                      const Eigen::Vector2d& left_now, const Eigen::Vector2d& right_now);

/// The paper's differential mapping, corrected: adds up advances from an initial pose. The sums telescope, so
/// the result is the snapshot's pose plus the error of the start: no drift, and no smoothing either.
class DifferentialMapper {
 public:
  /// `start` is the pose of the body when the tags were at these places.
  DifferentialMapper(const Pose2& start, const TagPair& tags, const Eigen::Vector2d& left_map,
                     const Eigen::Vector2d& right_map);

  void advance(const Eigen::Vector2d& left_map, const Eigen::Vector2d& right_map);
  Pose2 pose() const;

 private:
  Eigen::Vector2d middle_body_;
  Eigen::Vector2d middle_map_;
  double yaw_;
  Eigen::Vector2d left_map_;
  Eigen::Vector2d right_map_;
};

}  // namespace pos::uwb
