#include "pos/io/background.hpp"

#include <Eigen/LU>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "pos/core/error.hpp"
#include "pos/io/files.hpp"
#include "pos/io/text.hpp"

namespace pos::io {
namespace {

/// Extent of the points across the line that fits them best, over the extent along it.
double flatness(const cv::Mat& points) {
  cv::Mat covariance, mean;
  cv::calcCovarMatrix(points, covariance, mean, cv::COVAR_NORMAL | cv::COVAR_ROWS, CV_64F);
  cv::Mat values;
  cv::eigen(covariance, values);
  const double along = values.at<double>(0);
  return along > 0.0 ? std::sqrt(std::max(0.0, values.at<double>(1)) / along) : 0.0;
}

void requireSpread(const cv::Mat& points, const char* where) {
  if (flatness(points) > 1e-3) return;
  throw ConfigError(Complaint{.what = std::string("the control points lie on one line ") + where,
                              .key = "background.control_points",
                              .expected = "points that span an area",
                              .suggestion = "add a point away from the line"});
}

}  // namespace

AffineFit affineFit(const std::vector<map::ControlPoint>& points) {
  const int n = static_cast<int>(points.size());
  if (n < 3) {
    throw ConfigError(Complaint{.what = "the background has too few control points",
                                .key = "background.control_points",
                                .got = std::to_string(n),
                                .expected = "at least three"});
  }
  cv::Mat pixels(n, 2, CV_64F), places(n, 2, CV_64F), design(n, 3, CV_64F);
  for (int i = 0; i < n; ++i) {
    const map::ControlPoint& point = points[static_cast<std::size_t>(i)];
    const double values[] = {point.column, point.row, point.x, point.y};
    for (const double value : values) {
      if (std::isfinite(value)) continue;
      throw ConfigError(Complaint{.what = "a control point has a coordinate that is no number",
                                  .key = "background.control_points[" + std::to_string(i) + "]"});
    }
    for (int k = 0; k < 2; ++k) {
      pixels.at<double>(i, k) = design.at<double>(i, k) = values[k];
      places.at<double>(i, k) = values[2 + k];
    }
    design.at<double>(i, 2) = 1.0;
  }
  requireSpread(pixels, "in the picture");
  requireSpread(places, "on the map");
  cv::Mat solution;
  cv::solve(design, places, solution, cv::DECOMP_SVD);
  const cv::Mat misfit = design * solution - places;
  AffineFit fit;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column)
      fit.T_map_pixel(row, column) = solution.at<double>(column, row);
  }
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    fit.residuals.push_back(std::hypot(misfit.at<double>(i, 0), misfit.at<double>(i, 1)));
    sum += fit.residuals.back() * fit.residuals.back();
  }
  fit.rms = n > 3 ? std::sqrt(sum / n) : 0.0;
  const auto& T = fit.T_map_pixel;
  fit.metres_per_pixel = std::sqrt(std::abs(T(0, 0) * T(1, 1) - T(0, 1) * T(1, 0)));
  return fit;
}

BackgroundPicture loadPicture(const std::filesystem::path& file) {
  const std::filesystem::path path = existingFile(file);
  BackgroundPicture picture{.bytes = fileText(path)};
  const std::vector<unsigned char> bytes(picture.bytes.begin(), picture.bytes.end());
  const cv::Mat image = bytes.empty() ? cv::Mat() : cv::imdecode(bytes, cv::IMREAD_COLOR);
  if (image.empty()) {
    throw DataError(Complaint{.what = "the background is no picture that can be read",
                              .place = {.file = path.string()},
                              .expected = "PNG, JPEG, TIFF or another format of OpenCV"});
  }
  picture.columns = image.cols;
  picture.rows = image.rows;
  const bool known = picture.bytes.starts_with("\x89PNG") || picture.bytes.starts_with("\xff\xd8");
  if (!known) {
    std::vector<unsigned char> png;
    cv::imencode(".png", image, png);
    picture.bytes.assign(png.begin(), png.end());
  }
  return picture;
}

}  // namespace pos::io
