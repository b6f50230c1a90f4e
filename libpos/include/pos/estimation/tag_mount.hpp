#pragma once
/// Where a radio tag sits on the vehicle.

#include <Eigen/Core>
#include <vector>

#include "pos/core/measurement.hpp"

namespace pos::estimation {

/// Where a tag sits on the body (m, FLU; origin = the body frame of the log).
struct TagMount {
  TagId id = 0;
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();

  bool operator==(const TagMount&) const = default;
};

/// Finite places, each tag once; ConfigError with the key under `tags` otherwise.
void requireUniqueTags(const std::vector<TagMount>& tags);

}  // namespace pos::estimation
