#pragma once
/// State, motion and measurements of the `dual_uwb` filters (docs/math/dual_uwb.md). Pure functions.

#include <optional>

#include "pos/core/belief.hpp"
#include "pos/core/estimate.hpp"
#include "pos/core/pose2.hpp"
#include "pos/estimation/configs.hpp"
#include "pos/filters/ekf.hpp"
#include "pos/uwb/rigid.hpp"

namespace pos::estimation {

/// [x y yaw | speed, or velocity x and y in the map | yaw rate, or the gyro's bias | one bias for each link].
struct DualUwbState {
  static constexpr int kDof = Eigen::Dynamic;
  static constexpr int kMaxDof = 64;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxDof, 1>;
  Values values;

  Pose2 pose() const { return {values[0], values[1], values[2]}; }
};
DualUwbState plus(const DualUwbState& x, const Tangent<DualUwbState>& d);
Tangent<DualUwbState> minus(const DualUwbState& to, const DualUwbState& from);

/// Where each term sits. Throws ConfigError when the links do not fit.
class DualUwbLayout {
 public:
  DualUwbLayout(const DualUwbConfig& config, int anchors);

  int size() const { return core_ + links_; }
  /// Rows of everything but the links' biases.
  int core() const { return core_; }
  int links() const { return links_; }
  bool vehicle() const { return vehicle_; }
  bool gyro() const { return gyro_; }
  static constexpr int velocityRow() { return 3; }
  int rateRow() const { return core_ - 1; }
  /// Row of a link's bias; nothing where biases are no states.
  std::optional<int> linkRow(int tag, int anchor) const {
    return links_ == 0 ? std::nullopt : std::optional<int>(core_ + tag * anchors_ + anchor);
  }

 private:
  bool vehicle_;
  bool gyro_;
  int anchors_;
  int core_;
  int links_;
};

/// A step of every link's bias: b <- mean + keep (b - mean), less sure by the variance.
struct LinkStep {
  double keep = 1.0;
  double mean = 0.0;      ///< m
  double variance = 0.0;  ///< m^2
};

/// A step of motion: the core rows, and what the links' biases do meanwhile.
struct DualUwbStep {
  static constexpr int kMaxCore = 6;
  using Core = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxCore, kMaxCore>;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxCore, 1> next;
  Core F;
  Core Qd;
  LinkStep links = {};
};

/// A turn rate measured by a gyro, rad/s, and for how long it has been taken on trust.
struct GyroInput {
  double rate = 0.0;
  double age = 0.0;  ///< s since the sample; the true rate has wandered since
};

struct DualUwbMotion {
  const DualUwbLayout* layout;
  const DualUwbConfig* config;

  /// Constant turn rate and velocity over dt seconds, integrated at the heading of mid-step. Vehicle motion:
  /// the velocity lies `course_offset` from the body's x, plus yaw rate times `motion_centre_x` sideways.
  DualUwbStep step(const DualUwbState& x, GyroInput gyro, double dt) const;
  /// The vehicle stands: nothing but the links' biases changes.
  DualUwbStep standing(const DualUwbState& x, double dt) const;
};

/// x <- next, P <- F P F' + Qd with F beyond the core diagonal.
void predict(Belief<DualUwbState>& belief, const DualUwbStep& step);

using DualUwbRow = filters::Innovation<DualUwbState, 1>;

/// Range minus |p + R l - a| minus the link's bias.
DualUwbRow rangeInnovation(const DualUwbState& x, const DualUwbLayout& layout, const uwb::BodyRange& range,
                           double body_height, int tag, int anchor);

/// Speed of the wheels minus the velocity along the course, m/s.
DualUwbRow wheelInnovation(const DualUwbState& x, const DualUwbLayout& layout, const DualUwbConfig& config,
                           double speed, GyroInput gyro);

/// Zero minus the velocity across the course of the point the vehicle turns about (free motion), m/s.
DualUwbRow lateralInnovation(const DualUwbState& x, const DualUwbLayout& layout, const DualUwbConfig& config,
                             GyroInput gyro);

/// Velocity of the body frame and its yaw rate, in body axes, with covariance.
PlanarTwist twistOf(const Belief<DualUwbState>& belief, const DualUwbLayout& layout,
                    const DualUwbConfig& config, GyroInput gyro);

}  // namespace pos::estimation
