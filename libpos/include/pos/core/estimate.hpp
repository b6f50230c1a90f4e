#pragma once
/// Where an estimator believes the vehicle is.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pos/core/manifold.hpp"
#include "pos/core/pose3.hpp"
#include "pos/core/stamp.hpp"

namespace pos {

/// How the body frame moves over ground, in the map's plane, seen in body axes.
struct PlanarTwist {
  /// forward m/s, left m/s, yaw rate rad/s.
  Vector<3> rates = Vector<3>::Zero();
  Matrix<3, 3> covariance = Matrix<3, 3>::Zero();
};

/// One of the models an estimator chooses between, as it stands at an estimate's stamp.
struct ModeState {
  std::string_view name = {};  ///< points at a string literal
  double probability = 0.0;
  bool usable = false;
  /// Since when it is: the stamp of its first good measurement, or the moment the missing one was due.
  Stamp since = {};
  std::optional<Stamp> last_applied = {};  ///< stamp of its last measurement that was taken
  double sigma = 0.0;                      ///< m per axis, how good a place its latest readings give
};

/// A pose with its covariance. Tangent order [x y z (map axes), rotation (body axes)], m and rad.
/// A planar estimator fills x, y, yaw and leaves the rows of z, roll and pitch at zero.
struct Estimate {
  Stamp stamp;
  Pose3 T_map_body;
  Matrix<6, 6> covariance = Matrix<6, 6>::Zero();
  /// Where the estimator knows how fast it moves.
  std::optional<PlanarTwist> twist = {};
  /// Where the estimator chooses between models, in a fixed order.
  std::vector<ModeState> modes = {};

  /// Planar part [x, y, yaw]. For a level body the yaw row is the tangent's last.
  Matrix<3, 3> planarCovariance() const;
};

/// A planar belief as an Estimate at height z.
Estimate planarEstimate(Stamp stamp, const Pose2& mean, const Matrix<3, 3>& covariance, double z = 0.0);

/// One line of an estimator's state beyond the pose: a bias, a scale, the number of particles.
struct NamedValue {
  std::string name;  ///< with its unit: "range_offset_m"
  double value = 0.0;
  double sigma = 0.0;  ///< 0 where it has none
};

/// What an estimator tells of itself; a snapshot, in a fixed order for a given estimator.
using Diagnostics = std::vector<NamedValue>;

/// Reference trajectory, stamps strictly increasing.
struct TruthPose {
  Stamp stamp;
  Pose3 T_map_body;
};
struct Truth {
  std::vector<TruthPose> poses;
  bool has_z = true;
  bool has_yaw = true;
};

}  // namespace pos
