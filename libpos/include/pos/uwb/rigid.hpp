#pragma once
/// The pose of a body from the ranges of all its tags at once: rigid multilateration (spec A, section 2.4).
/// The tags' places on the body enforce the baseline exactly, and a pose needs only four ranges in all.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "pos/core/belief.hpp"
#include "pos/core/measurement.hpp"
#include "pos/core/pose2.hpp"
#include "pos/uwb/multilateration.hpp"

namespace pos::uwb {

/// One range of one tag on the body.
struct BodyRange {
  TagId tag = 0;
  Eigen::Vector3d tag_body = Eigen::Vector3d::Zero();    ///< m, FLU
  Eigen::Vector3d anchor_map = Eigen::Vector3d::Zero();  ///< m
  double range = 0.0;                                    ///< m, slant
  double sigma = 0.1;                                    ///< m
};

/// The range as multilateration of its tag alone wants it.
TagRange tagRange(const BodyRange& range, double body_height);

/// A range predicted from a pose, with its derivative by [x y yaw].
struct RangeRow {
  double distance = 0.0;  ///< m
  Vector<3> row = Vector<3>::Zero();
};

/// r = |p + R(yaw) l - a|; d r / d [x y yaw] = [u_x, u_y, u' R'(yaw) l].
RangeRow predictedRange(const Pose2& pose, double body_height, const Eigen::Vector3d& tag_body,
                        const Eigen::Vector3d& anchor_map);

/// One pose that the ranges fit.
struct RigidFix {
  Belief<Pose2> pose;
  double chi_square = 0.0;
  int dof = 0;
  std::uint32_t used = 0;  ///< bit i: range i was used
  bool consistent = true;
};

/// Up to four poses, the best fitting first. Collinear anchors mirror the whole vehicle: two tags fit either
/// side, one of them facing backwards.
struct RigidFixes {
  FixVerdict verdict = FixVerdict::TooFew;
  std::array<RigidFix, 4> fixes{};
  int count = 0;

  std::span<const RigidFix> all() const { return {fixes.data(), static_cast<std::size_t>(count)}; }
};

/// Every pose that fits, from nothing: started from the tags' own fixes where two tags have one, otherwise
/// from eight headings. At least four ranges of two tags; at most kMaxRanges. `body_height` is z of the body
/// frame.
RigidFixes rigidFixes(std::span<const BodyRange> ranges, double body_height, const ResidualTest& test);

/// The one pose next to `start` (a prediction).
RigidFixes rigidFixNear(std::span<const BodyRange> ranges, double body_height, const Pose2& start,
                        const ResidualTest& test);

}  // namespace pos::uwb
