#pragma once
/// Where to put anchors so that a target is met with few of them.

#include <vector>

#include "pos/map/coverage.hpp"

namespace pos::map {

struct PlanRules {
  double along = 0.3;            ///< m, bound to be met along the roadway
  double across = 1.0;           ///< m, bound to be met across it
  double met_share = 0.99;       ///< of all samples
  double candidate_step = 10.0;  ///< m of chainage between places tried, on both walls
  double anchor_height = 2.0;    ///< m above the floor
  CoverageRules coverage = {.step = 5.0};
};
PlanRules validated(PlanRules rules);

struct AnchorPlan {
  std::vector<Anchor> added = {};  ///< ids from the largest of the map on
  CoverageSummary before = {};
  CoverageSummary after = {};
  std::size_t samples_met = 0;
  std::size_t samples = 0;
  bool met = false;             ///< false: no further place helps
  double roadway_length = 0.0;  ///< m
  double anchorsPerKilometre() const;
};
/// Keeps the anchors of the map, adds greedily where most is gained, then takes away what is not needed.
/// Throws ConfigError for a map without roadways.
AnchorPlan plannedAnchors(const Network& network, const PlanRules& rules);

}  // namespace pos::map
