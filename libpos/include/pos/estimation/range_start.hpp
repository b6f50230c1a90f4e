#pragma once
/// Finding the first pose: from what is known, or from the first ranges.

#include <vector>

#include "pos/core/belief.hpp"
#include "pos/estimation/range_bank.hpp"
#include "pos/estimation/range_models.hpp"

namespace pos::estimation {

/// A belief over the whole state: the given planar pose, the configuration's priors for everything else.
Belief<RangeState> startBelief(const RangeOdometryConfig& config, const RangeLayout& layout,
                               const Belief<Pose2>& pose);

/// Equally likely beliefs with the position of `pose` and headings spread over the whole circle.
std::vector<RangeHypothesis> headingHypotheses(const RangeOdometryConfig& config, const RangeLayout& layout,
                                               const Belief<Pose2>& pose);

/// A range heard before the first pose was known, with the way travelled until then.
struct EarlyRange {
  Stamp stamp;
  RangeGeometry geometry;
  double range = 0.0;     ///< m
  double variance = 0.0;  ///< m^2
  Pose2 T_start_body;     ///< odometry since the first measurement
};

/// Gathers the first ranges until they fix a position: at least three anchors and `kEnough` ranges, with the
/// odometry in between. Then solves for the place, robustly, once per heading hypothesis.
class RangeStart {
 public:
  RangeStart(const RangeOdometryConfig& config, const RangeLayout& layout)
      : config_(&config), layout_(&layout) {}

  void move(const Pose2& increment) { T_start_body_ = T_start_body_ * increment; }
  void add(Stamp stamp, const RangeGeometry& geometry, double range, double variance);

  /// Hypotheses about the pose now; empty while the ranges do not suffice yet.
  std::vector<RangeHypothesis> solved() const;

 private:
  const RangeOdometryConfig* config_;
  const RangeLayout* layout_;
  Pose2 T_start_body_;
  std::vector<EarlyRange> early_;
};

}  // namespace pos::estimation
