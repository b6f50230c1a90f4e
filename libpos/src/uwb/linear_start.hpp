#pragma once
/// Multilateration without iterating, from differences of squared ranges.

#include <optional>

#include "gauss_newton.hpp"
#include "pos/uwb/multilateration.hpp"

namespace pos::uwb::detail {

/// The place that the squared ranges with a weight agree on best; nothing when their anchors are in line.
std::optional<Eigen::Vector2d> linearStart(std::span<const TagRange> ranges, const Weights& weights);

/// Places to start a fit from: the linear one and its mirror image where the anchors are nearly in line, both
/// sides of their line where they are in line. None for fewer than two anchors.
struct Starts {
  std::array<Eigen::Vector2d, 2> places;
  int count = 0;

  std::span<const Eigen::Vector2d> all() const { return {places.data(), static_cast<std::size_t>(count)}; }
};
Starts startingPlaces(std::span<const TagRange> ranges, const Weights& weights);

}  // namespace pos::uwb::detail
