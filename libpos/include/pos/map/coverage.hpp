#pragma once
/// How well ranges to the anchors can fix a tag along and across the roadway: Cramer-Rao bounds, chainage by
/// chainage. No estimator can do better from the ranges of one moment; motion and the walls help across.

#include <optional>
#include <vector>

#include "pos/map/network.hpp"

namespace pos::map {

struct CoverageRules {
  double range_sigma = 0.10;       ///< m, of one range; the anchor's survey sigma is added to it
  double range_limit = 120.0;      ///< m, of the radio
  double tag_height = 1.5;         ///< m above the floor, taken as known
  double step = 1.0;               ///< m of chainage
  double singular_sigma = 1000.0;  ///< m, a bound above this is called singular
};
CoverageRules validated(CoverageRules rules);

struct CoverageSample {
  TunnelPoint point = {};
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  int anchors = 0;  ///< in sight within range
  /// m, one standard deviation; nothing where the geometry is singular.
  std::optional<double> along = {};
  std::optional<double> across = {};
};

/// Bound at one point from the ranges to these places. `heading` is the roadway's.
CoverageSample bound(const Eigen::Vector3d& p_map, double heading, const std::vector<Anchor>& anchors,
                     const CoverageRules& rules);

/// Samples at the middle of every step of every roadway, in map order. Throws ConfigError for a map without
/// roadways: no samples would read as perfect coverage.
std::vector<CoverageSample> coverage(const Network& network, const CoverageRules& rules);
/// The same for one roadway.
std::vector<CoverageSample> coverage(const Network& network, RoadwayIndex roadway,
                                     const CoverageRules& rules);

/// Of many samples. Singular ones count as infinite.
struct CoverageSummary {
  std::size_t samples = 0;
  std::size_t singular = 0;
  int anchors_min = 0;
  double anchors_mean = 0.0;
  double along_median = 0.0;  ///< m
  double along_p90 = 0.0;
  double along_max = 0.0;
  double across_median = 0.0;
  double across_p90 = 0.0;
  double across_max = 0.0;
};
CoverageSummary summary(const std::vector<CoverageSample>& samples);

}  // namespace pos::map
