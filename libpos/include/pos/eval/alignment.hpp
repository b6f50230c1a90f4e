#pragma once
/// Moves an estimated trajectory onto the truth before comparing them. Default: none, because the estimate
/// lives in the mine's map frame and aligning would hide an error of map or anchors. The other modes are for
/// dead reckoning, whose start is arbitrary.

#include <array>
#include <string_view>
#include <vector>

#include "pos/core/pose3.hpp"
#include "pos/eval/association.hpp"

namespace pos::eval {

enum class AlignmentMode {
  None,
  Origin,  ///< the first matched pose is laid on the truth's
  Se2,     ///< x, y and yaw, least squares over all matched positions
  Se3,     ///< all six, least squares (Umeyama 1991, equations 39-42, scale held at 1)
  PosYaw,  ///< x, y, z and yaw, least squares: gravity is trusted
};

inline constexpr std::array kAlignmentModes{AlignmentMode::None, AlignmentMode::Origin, AlignmentMode::Se2,
                                            AlignmentMode::Se3, AlignmentMode::PosYaw};

/// "none", "origin", "se2", "se3", "posyaw".
std::string_view name(AlignmentMode mode);

/// aligned pose = T_truth_estimate * estimated pose. No scale is ever applied.
struct Alignment {
  AlignmentMode mode = AlignmentMode::None;
  Pose3 T_truth_estimate;
};

/// The transform of `mode` for these pairs; the identity for an empty list. `truth` says which coordinates
/// the truth has; it throws UsageError where the mode needs one that is missing and DataError where the
/// positions cannot tell the rotation (standing still; for Se3 also a straight line).
Alignment alignment(const std::vector<MatchedPose>& pairs, AlignmentMode mode, const Truth& truth);

/// The estimate moved by the alignment; the position covariance turns with it.
Estimate aligned(const Estimate& estimate, const Alignment& alignment);

}  // namespace pos::eval
