#include "pos/map/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pos/core/config_checks.hpp"
#include "range_information.hpp"

namespace pos::map {
namespace {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto last = static_cast<double>(values.size() - 1);
  const auto k = static_cast<std::ptrdiff_t>(std::lround(share * last));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

}  // namespace

Eigen::Matrix2d rangeInformation(const Eigen::Vector3d& p_map, double heading, const Anchor& anchor,
                                 double range_sigma) {
  const Eigen::Vector3d d = p_map - anchor.p_map;
  const double range = d.norm();
  if (!(range > 0.0)) return Eigen::Matrix2d::Zero();
  const Eigen::Vector2d h = Eigen::Vector2d(std::cos(heading) * d.x() + std::sin(heading) * d.y(),
                                            -std::sin(heading) * d.x() + std::cos(heading) * d.y()) /
                            range;
  return h * h.transpose() / (range_sigma * range_sigma + anchor.survey_sigma * anchor.survey_sigma);
}

CoverageRules validated(CoverageRules rules) {
  requirePositive(rules.range_sigma, "range_sigma_m", "m");
  requirePositive(rules.range_limit, "range_limit_m", "m");
  requirePositive(rules.step, "step_m", "m");
  requirePositive(rules.singular_sigma, "singular_sigma_m", "m");
  requireNotNegative(rules.tag_height, "tag_height_m", "m");
  return rules;
}

CoverageSample bound(const Eigen::Vector3d& p_map, double heading, const std::vector<Anchor>& anchors,
                     const CoverageRules& rules) {
  Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
  for (const Anchor& anchor : anchors) J += rangeInformation(p_map, heading, anchor, rules.range_sigma);
  CoverageSample sample{.p_map = p_map, .anchors = static_cast<int>(anchors.size())};
  // Var(along) = J22 / det, Var(across) = J11 / det; a singular J makes at least one of them infinite.
  const double det = J(0, 0) * J(1, 1) - J(0, 1) * J(0, 1);
  const double largest = rules.singular_sigma * rules.singular_sigma * det;
  if (det > 1e-12 * J(0, 0) * J(1, 1) && J(1, 1) < largest) sample.along = std::sqrt(J(1, 1) / det);
  if (det > 1e-12 * J(0, 0) * J(1, 1) && J(0, 0) < largest) sample.across = std::sqrt(J(0, 0) / det);
  return sample;
}

std::vector<CoverageSample> coverage(const Network& network, RoadwayIndex roadway,
                                     const CoverageRules& rules) {
  (void)validated(rules);
  const Centreline& line = network.centreline(roadway);
  const auto steps = static_cast<int>(std::max(1.0, std::round(line.length() / rules.step)));
  std::vector<CoverageSample> samples;
  for (int i = 0; i < steps; ++i) {
    const double chainage = line.chainageStart() + line.length() * (i + 0.5) / steps;
    const TunnelPoint point{roadway, chainage, 0.0, rules.tag_height};
    const Eigen::Vector3d p_map = network.toMap(point);
    std::vector<Anchor> seen;
    for (const std::size_t a : network.visibleAnchors(p_map, rules.range_limit))
      seen.push_back(network.map().anchors[a]);
    samples.push_back(bound(p_map, line.at(chainage).heading, seen, rules));
    samples.back().point = point;
  }
  return samples;
}

std::vector<CoverageSample> coverage(const Network& network, const CoverageRules& rules) {
  if (network.map().roadways.empty()) {
    throw ConfigError(Complaint{.what = "the map has no roadways, so there is nowhere to ask for coverage",
                                .key = "roadways",
                                .suggestion = "add the roadways to the map"});
  }
  std::vector<CoverageSample> all;
  for (RoadwayIndex r = 0; r < network.map().roadways.size(); ++r) {
    const std::vector<CoverageSample> samples = coverage(network, r, rules);
    all.insert(all.end(), samples.begin(), samples.end());
  }
  return all;
}

CoverageSummary summary(const std::vector<CoverageSample>& samples) {
  CoverageSummary summary{.samples = samples.size()};
  if (samples.empty()) return summary;
  std::vector<double> along;
  std::vector<double> across;
  double anchors = 0.0;
  summary.anchors_min = samples.front().anchors;
  for (const CoverageSample& sample : samples) {
    along.push_back(sample.along.value_or(std::numeric_limits<double>::infinity()));
    across.push_back(sample.across.value_or(std::numeric_limits<double>::infinity()));
    summary.singular += sample.along && sample.across ? 0 : 1;
    summary.anchors_min = std::min(summary.anchors_min, sample.anchors);
    anchors += sample.anchors;
  }
  summary.anchors_mean = anchors / static_cast<double>(samples.size());
  summary.along_median = quantile(along, 0.5);
  summary.along_p90 = quantile(along, 0.9);
  summary.along_max = quantile(along, 1.0);
  summary.across_median = quantile(across, 0.5);
  summary.across_p90 = quantile(across, 0.9);
  summary.across_max = quantile(across, 1.0);
  return summary;
}

}  // namespace pos::map
