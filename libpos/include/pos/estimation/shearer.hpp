#pragma once
/// `shearer`: inertial navigation of a longwall shearer held by the legs of the supports (Zheng et al. 2021,
/// corrected). docs/math/shearer.md walks through it in the order of this code.

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "pos/estimation/configs.hpp"
#include "pos/estimation/creep_watch.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/estimation/inertial_intake.hpp"
#include "pos/estimation/leg_scene.hpp"
#include "pos/estimation/shearer_filter.hpp"
#include "pos/lidar/legs.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation {

/// The Earth under a level map. Throws ConfigError when it is to turn and the map has no tie to the Earth.
ins::Earth shearerEarth(const ShearerConfig& config, const map::TunnelMap& map);
/// The inertial unit at the start, and the covariance of [phi, v, p, biases]; `given` replaces the planar
/// part of the configured pose.
ins::NavigationState shearerStart(const ShearerConfig& config, const std::optional<Belief<Pose2>>& given);
Eigen::Matrix<double, 15, 15> shearerStartCovariance(const ShearerConfig& config,
                                                     const std::optional<Belief<Pose2>>& given);

class Shearer final : public Estimator {
 public:
  /// Throws ConfigError for a map without an origin where the Earth turns.
  Shearer(const ShearerConfig& config, const std::shared_ptr<const map::TunnelMap>& map);

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  Diagnostics diagnostics() const override;

  /// The legs of a whole sweep taken now: those expected, those found and which of these the filter uses.
  /// Changes nothing. Empty before the start.
  LegScene legScene(const Scan2D& sweep) const;

 private:
  /// What the first pass consisted of, kept for the restart of PICM.
  struct KeptLeg {
    Eigen::Vector3d measured;
    Eigen::Matrix3d covariance;
    double age;
  };
  using Kept = std::variant<ins::ImuIncrement, KeptLeg>;

  IngestReport take(const Measurement& measurement, const ImuSample& sample);
  IngestReport take(const Measurement& measurement, const Scan2D& scan);
  IngestReport take(const Measurement& measurement, const OdometryIncrement& odometry);
  IngestReport take(const Measurement& measurement, const WheelSpeeds& speeds);
  IngestReport roll(const WheelIntake::Told& told);
  IngestReport takeRoadway(const Scan2D& sweep);
  Eigen::Quaterniond faceAxes() const;
  template <class Other>
  IngestReport take(const Measurement&, const Other&) {
    return {.verdict = Verdict::Unsupported, .reason = "shearer has no use for this kind of reading"};
  }
  IngestReport takePoint(Stamp stamp, const Scan2D& scan);
  IngestReport takeSweep(Stamp stamp, const Scan2D& scan);
  IngestReport takeLeg(Stamp stamp, const Eigen::Vector3d& measured, const Eigen::Matrix3d& covariance);
  void start();
  void chooseMode();
  void alignMount();
  const ShearerFilter& best() const { return filters_.front(); }

  ShearerConfig config_;
  ins::Earth earth_;
  lidar::LegFinder finder_;
  std::vector<ShearerFilter> filters_;  // one, or modes 2 and 7 until the first end 2
  std::optional<Belief<Pose2>> given_;
  std::optional<Stamp> last_stamp_;
  ImuIntake imu_;
  bool running_ = false;
  bool keeping_ = false;
  std::vector<Kept> kept_;
  double eta_ = 0.0;
  bool was_degraded_ = false;
  WheelIntake wheels_;
  CreepWatch creep_;
};

}  // namespace pos::estimation
