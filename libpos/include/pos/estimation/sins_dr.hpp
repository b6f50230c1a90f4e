#pragma once
/// `sins_dr`: inertial navigation and wheels side by side, with a 21-state error filter on the difference of
/// their positions, learnt noise, slip isolation and outside fixes (Jiang et al. 2024, corrected).
/// docs/math/sins_dr.md walks through it in the order of this code.

#include <memory>
#include <optional>

#include "pos/estimation/configs.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/estimation/inertial_intake.hpp"
#include "pos/estimation/map_earth.hpp"
#include "pos/estimation/sins_state.hpp"
#include "pos/estimation/slip_watch.hpp"
#include "pos/estimation/wheel_slide.hpp"
#include "pos/filters/noise_adaptation.hpp"

namespace pos::estimation {

class SinsDr final : public Estimator {
 public:
  /// Throws ConfigError when the ellipsoid is wanted and the map has no tie to the Earth.
  SinsDr(const SinsDrConfig& config, const std::shared_ptr<const map::TunnelMap>& map);

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  Diagnostics diagnostics() const override;

 private:
  /// What the wheels did since some moment.
  struct Rolling {
    double way = 0.0;                                   ///< m, scale taken off
    double turn = 0.0;                                  ///< rad, by the wheels
    double time = 0.0;                                  ///< s
    Eigen::Vector3d moved_n = Eigen::Vector3d::Zero();  ///< m, of the inertial unit

    void add(const Rolling& more);
  };

  IngestReport take(Stamp stamp, const ImuSample& sample);
  IngestReport take(Stamp stamp, const WheelTicks& ticks);
  IngestReport take(Stamp stamp, const WheelSpeeds& speeds);
  IngestReport take(Stamp stamp, const OdometryIncrement& odometry);
  IngestReport take(Stamp stamp, const PassageFix& fix);
  template <class Other>
  IngestReport take(Stamp, const Other&) {
    return {.verdict = Verdict::Unsupported, .reason = "sins_dr has no use for this kind of reading"};
  }

  // Standing still before the start.
  IngestReport align(Stamp stamp, const ins::ImuIncrement& raw);
  void start(Stamp stamp);
  Belief<Pose2> prior() const;

  // Inertial part.
  IngestReport strapdown(Stamp stamp, const ins::ImuIncrement& raw);
  void propagate();
  bool quiet() const { return standstill_.still(); }
  bool standing(Stamp stamp) const;
  void standStill();

  // Wheels.
  IngestReport roll(Stamp stamp, const WheelIntake::Told& told);
  IngestReport compare(Stamp stamp);
  SlipEvidence evidence(Stamp stamp, double difference_nis) const;
  double jump() const;
  void addReturn(SlipEvidence& evidence) const;
  void watchSlide(Stamp stamp);
  double wheelVelocitySigma() const;
  bool turnsAgree() const;
  IngestReport act(Stamp stamp, SlipAction action, IngestReport report);
  void whileIsolated();
  void takeWheelVelocity();
  SinsDrInput input(const Rolling& rolling) const;
  double ageOf(Stamp stamp) const { return seconds(stamp - *imu_.stamp()); }

  SinsDrConfig config_;
  MapEarth earth_;
  filters::Gate difference_gate_;
  filters::Gate jump_gate_;
  filters::Gate release_gate_;
  Belief<SinsDrState> belief_;
  bool running_ = false;
  std::optional<Belief<Pose2>> given_;  // by reset
  std::optional<Stamp> last_stamp_;

  ins::StandstillDetector standstill_;
  RestAlignment rest_;
  BlindDrive blind_;  // before the alignment was over

  ImuIntake imu_;
  ins::ImuIncrement last_increment_;                     // biases off
  ins::RestAverage rate_;                                // readings since the last update
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();  // m/s since the last propagation
  double unpropagated_ = 0.0;                            // s

  WheelIntake wheels_;
  Eigen::Quaterniond q_at_wheels_ = Eigen::Quaterniond::Identity();
  Rolling since_update_;
  Rolling unpropagated_rolling_;  // what the covariance of the wheels' position does not hold yet
  double wheel_interval_ = 0.02;
  std::optional<Stamp> update_stamp_;
  Eigen::Vector3d coordinates_at_update_ = Eigen::Vector3d::Zero();

  SlipWatch slip_;
  double variance_when_isolated_ = 0.0;
  WheelSlide slide_;
  Eigen::Vector3d mechanised_v_ = Eigen::Vector3d::Zero();    // m/s, changes by the strapdown alone
  Eigen::Vector3d mechanised_way_ = Eigen::Vector3d::Zero();  // m, its integral since the last update
  filters::NoiseAdaptation<3> noise_;
  double last_nis_ = 0.0;
};

}  // namespace pos::estimation
