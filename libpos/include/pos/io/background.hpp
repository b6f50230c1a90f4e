#pragma once
/// A scanned plan and where it lies on the map.

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "pos/map/furniture.hpp"

namespace pos::io {

/// Fitted by least squares to control points: map = T_map_pixel * [column, row, 1], m.
struct AffineFit {
  Eigen::Matrix<double, 2, 3> T_map_pixel = Eigen::Matrix<double, 2, 3>::Zero();
  std::vector<double> residuals = {};  ///< m, of each control point
  double rms = 0.0;                    ///< m; 0 for three points, which say nothing about themselves
  double metres_per_pixel = 0.0;       ///< root of the area of a pixel
};
/// Throws ConfigError for fewer than three points, for points (almost) on one line in the picture or on the
/// map, and for numbers that are none.
AffineFit affineFit(const std::vector<map::ControlPoint>& points);

struct BackgroundPicture {
  std::string bytes = {};  ///< PNG or JPEG; other formats OpenCV reads are converted to PNG
  int columns = 0;
  int rows = 0;
};
/// Throws ConfigError for a file that is missing, DataError for one that is no picture.
BackgroundPicture loadPicture(const std::filesystem::path& file);

}  // namespace pos::io
