#pragma once
/// A sweep of a laser scanner along a row of supports: what came back, the legs found in it, and the supports
/// they were taken for.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "pos/report/drawing.hpp"

namespace pos::report {

/// All points in the scanner's plane: x along the face (forward), y to the left, m; the scanner at the
/// origin.
struct LegPicture {
  std::string title = {};
  std::vector<Eigen::Vector2d> returns = {};

  /// Where the leg of a support was expected.
  struct Expected {
    int support = 0;
    Eigen::Vector2d p = Eigen::Vector2d::Zero();
    bool moved = false;  ///< moves, or has moved, in this cycle: not to be used
  };
  std::vector<Expected> expected = {};

  /// A leg that was found.
  struct Found {
    Eigen::Vector2d p = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< m^2
    std::optional<int> support = {};                       ///< it was taken for; nothing where it was dropped
    bool used = false;                                     ///< it went into the filter
  };
  std::vector<Found> found = {};

  double radius = 0.15;  ///< m, of a leg
  double gate = 0.5;     ///< m, about an expected leg
};

/// One scale in both axes, the part of the face that holds something. Expected legs are rings with the
/// gate about them, found ones crosses with a line to the support they were taken for; ellipses are of 3
/// sigma and drawn 10 times too large. The same picture gives the same bytes.
Drawing legDrawing(const LegPicture& picture);

}  // namespace pos::report
