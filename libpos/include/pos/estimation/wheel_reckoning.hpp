#pragma once
/// `dead_reckoning`, variants `encoders`, `encoders_attitude` and `ekf_heading`: two wheels, with and without
/// an inertial attitude (Jiang et al. 2024, section 1). docs/math/dead_reckoning.md walks through it.

#include <memory>
#include <optional>

#include "pos/estimation/configs.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/estimation/gyro_wheel.hpp"
#include "pos/estimation/inertial_intake.hpp"
#include "pos/estimation/map_earth.hpp"
#include "pos/estimation/wheel_heading.hpp"

namespace pos::estimation {

class WheelReckoning final : public Estimator {
 public:
  /// Throws ConfigError when the ellipsoid is wanted and the map has no tie to the Earth.
  WheelReckoning(const DeadReckoningConfig& config, const std::shared_ptr<const map::TunnelMap>& map);

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  Diagnostics diagnostics() const override;

 private:
  using Variant = DeadReckoningConfig::Variant;

  IngestReport take(Stamp stamp, const ImuSample& sample);
  IngestReport take(Stamp stamp, const WheelTicks& ticks) { return roll(stamp, wheels_.take(stamp, ticks)); }
  IngestReport take(Stamp stamp, const WheelSpeeds& speeds) {
    return roll(stamp, wheels_.take(stamp, speeds));
  }
  IngestReport take(Stamp stamp, const OdometryIncrement& odometry) {
    return roll(stamp, wheels_.take(stamp, odometry));
  }
  template <class Other>
  IngestReport take(Stamp, const Other&) {
    return {.verdict = Verdict::Unsupported, .reason = "dead reckoning has no use for this kind of reading"};
  }

  bool usesGyros() const { return config_.variant != Variant::Encoders; }
  Belief<Pose2> prior() const;
  void startHeading(const Eigen::Matrix3d& R_map_body);
  void startGyros();

  // Gyros.
  void turn(Stamp stamp, const ins::ImuIncrement& raw);
  void propagate();
  bool standing(Stamp stamp) const;

  // Wheels.
  IngestReport roll(Stamp stamp, const WheelIntake::Told& told);
  void rollGyros(Stamp stamp, const WheelReading& reading);
  void driveHeading(const WheelReading& reading);

  Eigen::Matrix3d R_map_n() const { return earth_.R_map_n(gyros_.mean.coordinates); }
  Estimate headingEstimate() const;
  Estimate gyroEstimate() const;

  DeadReckoningConfig config_;
  MapEarth earth_;
  bool running_ = false;
  std::optional<Belief<Pose2>> given_;  // by reset
  std::optional<Stamp> last_stamp_;
  double distance_ = 0.0;  // m rolled

  ImuIntake imu_;
  ins::StandstillDetector standstill_;
  RestAlignment rest_;
  BlindDrive blind_;  // before the alignment was over
  Belief<GyroWheel> gyros_;
  ins::ImuIncrement last_increment_;  // bias off
  ins::RestAverage rate_;             // readings at rest
  double unpropagated_ = 0.0;         // s

  WheelIntake wheels_;
  std::optional<Stamp> rolled_stamp_;
  Eigen::Quaterniond q_at_wheels_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_n_ = Eigen::Vector3d::Zero();  // m/s, of the axle's middle by the wheels and gyros
  Belief<WheelHeading> heading_;
  double speed_ = 0.0;  // m/s, by the wheels
};

}  // namespace pos::estimation
