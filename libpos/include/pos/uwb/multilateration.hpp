#pragma once
/// Where one tag is, from ranges to surveyed anchors (spec A, section 2.3). Level plane; the tag's height is
/// known. Nothing allocates.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "pos/uwb/residual_test.hpp"

namespace pos::uwb {

/// One range from the tag to an anchor.
struct TagRange {
  Eigen::Vector2d anchor = Eigen::Vector2d::Zero();  ///< m, map
  double height = 0.0;                               ///< m, anchor above the tag
  double range = 0.0;                                ///< m, slant
  double sigma = 0.1;                                ///< m
};

/// One place that the ranges fit.
struct TagFix {
  Eigen::Vector2d p_map = Eigen::Vector2d::Zero();       ///< m
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< m^2
  double chi_square = 0.0;                               ///< of the ranges used
  int dof = 0;                                           ///< redundant ranges
  std::uint32_t used = 0;                                ///< bit i: range i was used
  bool consistent = true;  ///< the residual test passed; where not, the covariance is inflated
};

enum class FixVerdict : std::uint8_t {
  Solved,      ///< one place
  Ambiguous,   ///< two mirror images, or more: to be resolved by the caller, never averaged
  TooFew,      ///< too few ranges
  Degenerate,  ///< the anchors' places say nothing, or no fit converged
};

/// Up to two places, the better fitting first.
struct TagFixes {
  FixVerdict verdict = FixVerdict::TooFew;
  std::array<TagFix, 2> fixes{};
  int count = 0;

  std::span<const TagFix> all() const { return {fixes.data(), static_cast<std::size_t>(count)}; }
};

/// Linear start, Gauss-Newton, residual test at the significance of `test`, leave-one-out, then Huber's
/// weights against bad ranges of either sign. Anchors (nearly) in line, two of them among that, give both
/// mirror images about the line, unless the ranges themselves tell which it is. At most kMaxRanges ranges.
/// Covariance is the Cramer-Rao bound; it is inflated only where the residual test fails in the end (the
/// source inflates by max(1, chi^2 / dof) always, which is 25 % too much on average with five redundant
/// ranges).
TagFixes multilaterated(std::span<const TagRange> ranges, const ResidualTest& test);

/// Drops the places for which `inside(p_map)` is false, unless none would remain: then the map is no judge.
template <class Fixes, class Inside>
Fixes keptInside(Fixes fixes, const Inside& inside) {
  Fixes kept = fixes;
  kept.count = 0;
  for (const auto& fix : fixes.all()) {
    if (inside(fix)) kept.fixes[static_cast<std::size_t>(kept.count++)] = fix;
  }
  if (kept.count == 0) return fixes;
  kept.verdict = kept.count == 1 ? FixVerdict::Solved : FixVerdict::Ambiguous;
  return kept;
}

/// Dilution of precision at a place: sigma of x, y and both per metre of range sigma. Infinite where the
/// anchors in view do not fix the place.
struct Dilution {
  double x = 0.0;
  double y = 0.0;
  double horizontal = 0.0;
};
Dilution dilutionAt(const Eigen::Vector2d& p_map, std::span<const TagRange> ranges);

}  // namespace pos::uwb
