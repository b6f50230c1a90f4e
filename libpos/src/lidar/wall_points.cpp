/// Points of walls, with normals, from a sweep.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "pos/lidar/icp.hpp"

namespace pos::lidar {
namespace {

struct Seen {
  Eigen::Vector2d p;  // m
  double range;       // m
};

std::vector<Seen> returnsOf(const Scan2D& scan, const ScannerCalibration& calibration) {
  std::vector<Seen> seen;
  const std::size_t beams = std::min(scan.ranges.size(), scan.valid.size());
  for (std::size_t i = 0; i < beams; ++i) {
    const double measured = static_cast<double>(scan.ranges[i]);
    if (scan.valid[i] == 0 || !(measured > 0.0 && measured < scan.range_max)) continue;
    const double range = calibratedRange(measured, calibration);
    const double angle =
        calibratedAngle(scan.angle_first + static_cast<double>(i) * scan.angle_step, calibration);
    const Eigen::Vector2d p(range * std::cos(angle), range * std::sin(angle));
    if (range > 0.0 && p.allFinite()) seen.push_back({p, range});
  }
  return seen;
}

struct Window {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Finds the pieces of wall around the returns of one sweep.
struct Walls {
  const std::vector<Seen>& seen;
  const WallConfig& config;
  double angle_step;

  bool joined(std::size_t i, std::size_t next) const {
    const double step = std::abs(angle_step) * std::min(seen[i].range, seen[next].range);
    return (seen[next].p - seen[i].p).norm() <= std::max(config.jump_min, config.jump_steps * step);
  }

  Window around(std::size_t i) const {
    const auto wanted = static_cast<std::size_t>(config.neighbours);
    const auto near = [&](std::size_t j) { return (seen[j].p - seen[i].p).norm() <= config.reach; };
    Window window{i, i + 1};
    while (window.begin > 0 && joined(window.begin - 1, window.begin) &&
           (i - window.begin < wanted || near(window.begin - 1))) {
      --window.begin;
    }
    while (window.end < seen.size() && joined(window.end - 1, window.end) &&
           (window.end - 1 - i < wanted || near(window.end))) {
      ++window.end;
    }
    return window;
  }

  /// Return i laid onto the line through its window, with that line's normal towards the scanner; nothing
  /// where they are no line. The line has less noise than the return.
  std::optional<WallPoint> point(std::size_t i, const Window& window) const {
    const std::size_t count = window.end - window.begin;
    if (count < static_cast<std::size_t>(config.neighbours) + 1 || count < 3) return {};
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (std::size_t j = window.begin; j < window.end; ++j) mean += seen[j].p;
    mean /= static_cast<double>(count);
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (std::size_t j = window.begin; j < window.end; ++j) {
      const Eigen::Vector2d off = seen[j].p - mean;
      scatter += off * off.transpose();
    }
    scatter /= static_cast<double>(count);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
    axes.computeDirect(scatter);
    const double across = std::max(axes.eigenvalues()[0], 0.0);
    if (!(std::sqrt(across) <= config.straight_rms && across < 0.1 * axes.eigenvalues()[1])) return {};
    const Eigen::Vector2d n = axes.eigenvectors().col(0);
    const Eigen::Vector2d p = seen[i].p - n.dot(seen[i].p - mean) * n;
    return WallPoint{.p = p, .normal = n.dot(p) > 0.0 ? Eigen::Vector2d(-n) : n};
  }
};

}  // namespace

std::vector<WallPoint> wallPoints(const Scan2D& scan, const WallConfig& config) {
  const std::vector<Seen> seen = returnsOf(scan, config.calibration);
  const Walls walls{seen, config, scan.angle_step};
  std::vector<WallPoint> points;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::optional<WallPoint> point = walls.point(i, walls.around(i));
    if (point) points.push_back(*point);
  }
  return points;
}

}  // namespace pos::lidar
