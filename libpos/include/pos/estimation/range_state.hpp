#pragma once
/// The state of `range_odometry`: a planar pose and whatever calibration terms the configuration frees.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "pos/core/manifold.hpp"
#include "pos/core/measurement.hpp"
#include "pos/core/pose2.hpp"
#include "pos/estimation/configs.hpp"

namespace pos::estimation {

/// Terms beside the pose. Each is either a state or held at a configured value.
enum class StateTerm : std::size_t {
  VelocityX,    ///< m/s, map axes
  VelocityY,    ///< m/s, map axes
  YawRate,      ///< rad/s
  GyroBias,     ///< rad/s, subtracted from the odometry's yaw rate
  WheelScale,   ///< true distance / odometry's distance
  RangeScale,   ///< range read / true distance
  RangeOffset,  ///< m, added to every range
  Latency,      ///< s, a range tells of this long before its stamp
};
inline constexpr std::size_t kStateTerms = 8;

/// Where each term sits in the state vector: [x y yaw, freed terms in the enum's order, one offset per
/// anchor].
class RangeLayout {
 public:
  /// Frees the terms whose sigma is positive (and velocity and yaw rate in constant-velocity motion).
  /// Throws ConfigError when the anchors' offsets would not fit into RangeState::kMaxDof.
  RangeLayout(const RangeOdometryConfig& config, const std::vector<AnchorId>& anchors);

  int size() const { return size_; }
  /// Row of a freed term; nothing for a held one.
  std::optional<int> row(StateTerm term) const {
    const int row = rows_[static_cast<std::size_t>(term)];
    return row < 0 ? std::nullopt : std::optional<int>(row);
  }
  /// Row of this anchor's offset; nothing where offsets are not states or the anchor is unknown.
  std::optional<int> anchorRow(AnchorId anchor) const;
  double held(StateTerm term) const { return held_[static_cast<std::size_t>(term)]; }
  const std::vector<AnchorId>& anchors() const { return anchors_; }

 private:
  std::array<int, kStateTerms> rows_{};
  std::array<double, kStateTerms> held_{};
  std::vector<AnchorId> anchors_;  // sorted; empty unless offsets are states
  int first_anchor_row_ = 0;
  int size_ = 3;
};

/// The values, tangent = differences (yaw wrapped). Translation in map axes.
struct RangeState {
  static constexpr int kDof = Eigen::Dynamic;
  static constexpr int kMaxDof = 64;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxDof, 1>;
  Values values;

  Pose2 pose() const { return {values[0], values[1], values[2]}; }
  auto position() const { return values.head<2>(); }
  double value(const RangeLayout& layout, StateTerm term) const;
  Eigen::Vector2d velocity(const RangeLayout& layout) const;
};

RangeState plus(const RangeState& x, const Tangent<RangeState>& d);
Tangent<RangeState> minus(const RangeState& to, const RangeState& from);

}  // namespace pos::estimation
