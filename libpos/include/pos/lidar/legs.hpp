#pragma once
/// Finding the legs of hydraulic supports in a sweep of a planar laser scanner (Zheng et al. 2021, section 3;
/// spec B, B5 steps 1 and 2).
///
/// All points are in the frame of the scan, which is the paper's l: x forward, y left (towards the supports).
/// `sensorAxes` turns them into the paper's s.

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/lidar/angle_calibration.hpp"
#include "pos/lidar/circle_fit.hpp"

namespace pos::lidar {

/// C_l^s of the paper's eq. 3: x_s = -y_l, y_s = x_l.
inline Eigen::Vector2d sensorAxes(const Eigen::Vector2d& p_l) {
  return {-p_l.y(), p_l.x()};
}

struct LegConfig {
  double diameter = 0.30;          ///< m, of a leg
  double lateral = 4.0;            ///< m, y_l of the row: how far left of the scanner the legs stand
  double lateral_tolerance = 0.6;  ///< m
  double sigma_range = 0.010;      ///< m
  double sigma_angle = 3.5e-4;     ///< rad
  double jump_min = 0.15;          ///< m, between neighbouring returns of different things, at least
  double jump_steps = 3.0;         ///< the same, in steps of the beams' angle times the range
  int points_min = 4;              ///< in a cluster
  double width_max = 1.3;          ///< diameters
  double width_min = 0.4;          ///< diameters
  double rms_max = 3.0;            ///< of a fit, in sigma_range
  double tilt = 0.0;               ///< rad, of the legs against the scan plane's normal: 0 fits plain circles
  double tilt_bearing = 1.5707963267948966;  ///< rad, l frame, the way the upper or lower end leans
  ArcWeights weights =
      ArcWeights::Noise;                ///< Huber where specks of dust hang before the legs; twice the time
  ScannerCalibration calibration = {};  ///< taken out of every beam; the default leaves it raw
};

/// Throws ConfigError naming the first field that cannot be.
LegConfig validated(LegConfig config);

struct LegDetection {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();          ///< m, l frame: where the axis meets the plane
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< m^2, l frame
  double rms = 0.0;                                          ///< m, of the points' distances to the leg
  int points = 0;
};

/// Where every beam and every cluster of a sweep went.
/// clusters = few_points + outside + bad_width + bad_arc + off_row + bad_fit + the legs found.
struct LegCounts {
  int beams = 0;
  int returns = 0;  ///< beams that came back from within range
  int clusters = 0;
  int few_points = 0;  ///< fewer points than points_min
  int outside = 0;     ///< not within the part of the face that was asked for
  int bad_width = 0;
  int bad_arc = 0;  ///< does not bulge towards the scanner, or a straight edge fits better
  int off_row = 0;  ///< not `lateral` to the left
  int bad_fit = 0;  ///< the circle does not fit, or cannot be told
};

/// Legs: at least one was found. NoReturns: no beam came back, or the sweep is empty. NoLegs: something came
/// back, and no leg was in it.
enum class LegView { Legs, NoReturns, NoLegs };

/// A part of the face, m along x_l. All of it by default.
struct AlongFace {
  double from = -1e9;
  double to = 1e9;
};

struct LegSweep {
  std::span<const LegDetection> legs = {};  ///< in the order of the beams; until the finder's next sweep
  LegCounts counts = {};
  LegView view = LegView::NoReturns;
};

/// Keeps its working memory: a sweep of the same geometry as the one before allocates nothing.
class LegFinder {
 public:
  /// Throws ConfigError.
  explicit LegFinder(const LegConfig& config);

  /// Legs whose nearest points lie within `part`: what is not needed costs no fit. O(beams). Any scan is
  /// answered: beams that are not finite, not above zero or at the range limit count as no returns.
  LegSweep find(const Scan2D& scan, const AlongFace& part = {});

 private:
  struct Return {
    Eigen::Vector2d p;  // m, l frame
    double range;       // m
    int beam;
  };

  void aim(const Scan2D& scan);
  void gather(const Scan2D& scan);
  std::size_t clusterEnd(std::size_t begin) const;
  void judge(std::size_t begin, std::size_t end, const AlongFace& part);
  bool bulges(std::size_t begin, std::size_t end) const;
  bool onRow(double lateral) const;

  LegConfig config_;
  CircleFitConfig fit_;
  Eigen::Vector2d lean_;  // unit vector in the plane along which the cut of a leg is long
  double angle_first_ = 0.0;
  double angle_step_ = 0.0;
  std::vector<Eigen::Vector2d> looks_ = {};  // unit vector of every beam
  std::vector<Return> returns_ = {};
  std::vector<Eigen::Vector2d> arc_ = {};
  std::vector<LegDetection> legs_ = {};
  LegCounts counts_ = {};
};

}  // namespace pos::lidar
