#pragma once
/// Errors of one estimator, pose by pose. Error = estimate - truth, everywhere.

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "pos/eval/alignment.hpp"
#include "pos/eval/association.hpp"
#include "pos/eval/path_tangent.hpp"

namespace pos::eval {

/// An error and the standard deviation the estimator claimed for it (0: it claimed none).
struct ScalarError {
  double value = 0.0;
  double sigma = 0.0;
};

/// One recorded estimate against the truth at its stamp; m and rad.
struct ErrorSample {
  Stamp stamp;
  Pose3 T_map_estimate;  ///< after the alignment
  Pose3 T_map_truth;
  ScalarError x;  ///< map axes
  ScalarError y;
  std::optional<ScalarError> z;      ///< where the truth has a height
  std::optional<ScalarError> along;  ///< positive ahead of the truth; where the truth moves at all
  std::optional<ScalarError> cross;  ///< positive to the left of the truth's motion
  std::optional<ScalarError> yaw;    ///< wrapped, where the truth has a heading
  double xy = 0.0;                   ///< horizontal distance
  /// e^T P^-1 e of [x y] (2 dof) and [x y yaw] (3 dof); nothing where P cannot be inverted. P includes what
  /// the truth's own position is uncertain by, where that was given.
  std::optional<double> nees_xy;
  std::optional<double> nees_pose;
};

using ErrorSeries = std::vector<ErrorSample>;

/// The errors of all pairs after `alignment`. `truth_sigma` (m, per horizontal axis) is how good the truth
/// is; its square is added to the claimed position covariance for the NEES and nowhere else.
ErrorSeries errorSeries(const std::vector<MatchedPose>& pairs, const Alignment& alignment, const Truth& truth,
                        const PathTangentOptions& tangent = {}, double truth_sigma = 0.0);

/// Which error of a sample is meant.
enum class Component { Xy, X, Y, Z, Along, Cross, Yaw };

inline constexpr std::array kComponents{Component::Xy,    Component::X,     Component::Y,  Component::Z,
                                        Component::Along, Component::Cross, Component::Yaw};

/// "xy", "x", "y", "z", "along", "cross", "yaw".
std::string_view name(Component component);

/// That error of a sample; xy has no sigma.
std::optional<ScalarError> component(const ErrorSample& sample, Component which);
/// That error of every sample that has it, m or rad.
std::vector<double> values(const ErrorSeries& series, Component which);

}  // namespace pos::eval
