#pragma once
/// What a system that uses legs makes of a sweep: for pictures, not for the filter.

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace pos::estimation {

/// All points in scanner axes as the system corrects them: x along the face (forward), y towards the
/// supports, m.
struct LegScene {
  /// Where the leg of a support is expected.
  struct Expected {
    int support = 0;
    Eigen::Vector2d p = Eigen::Vector2d::Zero();
    bool moved = false;  ///< it may have moved in this cycle
  };
  std::vector<Expected> expected = {};

  /// A leg found in the sweep.
  struct Found {
    Eigen::Vector2d p = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< m^2
    std::optional<int> support = {};                       ///< that it is taken for
    bool used = false;                                     ///< a landmark of the filter
  };
  std::vector<Found> found = {};
  double radius = 0.15;  ///< m, of a leg
  double gate = 0.5;     ///< m, of the association
};

}  // namespace pos::estimation
