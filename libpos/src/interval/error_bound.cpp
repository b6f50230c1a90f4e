#include "pos/interval/error_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pos/core/config_checks.hpp"
#include "pos/core/square.hpp"

namespace pos::interval {
namespace {

/// Longest way of `merge` neighbouring spacings; at the end of a leg there may be fewer.
double longest(const std::vector<double>& spacings, std::size_t merge) {
  double longest = 0.0;
  for (std::size_t i = 0; i < spacings.size(); i += merge) {
    const auto first = spacings.begin() + static_cast<std::ptrdiff_t>(i);
    const auto last = spacings.begin() + static_cast<std::ptrdiff_t>(std::min(i + merge, spacings.size()));
    longest = std::max(longest, std::accumulate(first, last, 0.0));
  }
  return longest;
}

}  // namespace

DriftModel validated(DriftModel drift) {
  requireNotNegative(drift.reset_along, "reset_along", "m");
  requireNotNegative(drift.reset_across, "reset_across", "m");
  requireNotNegative(drift.scale, "scale");
  requireNotNegative(drift.random_along, "random_along", "m");
  requireNotNegative(drift.heading, "heading", "rad");
  requireNotNegative(drift.gyro_bias, "gyro_bias", "rad/s");
  requireNotNegative(drift.gyro_noise, "gyro_noise", "rad/sqrt(s)");
  return drift;
}

double alongBound(const DriftModel& drift, double length) {
  return std::sqrt(square(drift.reset_along) + square(drift.scale * length) + drift.random_along * length);
}

double acrossBound(const DriftModel& drift, double length, double speed) {
  return std::sqrt(square(drift.reset_across) + square(drift.heading * length) +
                   square(drift.gyro_bias * square(length) / (2.0 * speed)) +
                   square(drift.gyro_noise) * length * length * length / (3.0 * speed));
}

std::optional<int> largestMerge(const DriftModel& drift, const LegDesign& leg) {
  validated(drift);
  if (leg.spacings.empty() || !(leg.speed > 0.0) || !(leg.width > 0.0))
    throw ConfigError(Complaint{.what = "a leg to be designed has chambers, a width and a speed"});
  const double smallest = *std::min_element(leg.spacings.begin(), leg.spacings.end());
  std::optional<int> largest;
  for (std::size_t merge = 1; merge <= leg.spacings.size(); ++merge) {
    const double length = longest(leg.spacings, merge);
    const bool along = 3.0 * alongBound(drift, length) <= 0.5 * smallest;
    const bool across = 3.0 * acrossBound(drift, length, leg.speed) <= 0.5 * leg.width;
    if (!along || !across) break;
    largest = static_cast<int>(merge);
  }
  return largest;
}

}  // namespace pos::interval
