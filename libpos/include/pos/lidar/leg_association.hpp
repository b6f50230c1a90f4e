#pragma once
/// Which support a leg belongs to (spec B, B5 step 3).

#include <Eigen/Core>
#include <span>
#include <vector>

namespace pos::lidar {

/// Where a support's leg should be seen, in the frame of the points to be matched.
struct PredictedLeg {
  int support = 0;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< m
};

/// Matched: the nearest predicted leg lies within the gate, no other does, and no other detection claims it.
/// Far: none lies within the gate. Ambiguous: two do. Contested: it does, but another detection claims the
/// same support. All but Matched are to be dropped.
enum class LegMatch { Matched, Far, Ambiguous, Contested };

struct LegAssociation {
  LegMatch match = LegMatch::Far;
  int predicted = -1;     ///< index into the predictions, the nearest one; -1 where there is none
  double distance = 0.0;  ///< m, to it
};

/// One answer for every detection, in their order. Points of both kinds lie in one plane frame, whichever;
/// `gate` in m. A detection that is not finite is Far. O(detections * predictions).
std::vector<LegAssociation> associated(std::span<const Eigen::Vector2d> detections,
                                       std::span<const PredictedLeg> predictions, double gate = 0.5);

/// The same, sweep after sweep, in memory that it keeps.
class LegMatcher {
 public:
  explicit LegMatcher(double gate = 0.5) : gate_(gate) {}
  /// Good until the next call.
  std::span<const LegAssociation> match(std::span<const Eigen::Vector2d> detections,
                                        std::span<const PredictedLeg> predictions);

 private:
  double gate_;
  std::vector<LegAssociation> answers_ = {};
};

}  // namespace pos::lidar
