#pragma once
/// `uwb_imu`: one radio tag and an inertial unit, tightly coupled (J. China Coal Soc. 2024, doi
/// 10.13225/j.cnki.jccs.2024.0676, section 1). docs/math/eskf.md walks through it.

#include <memory>
#include <optional>

#include "pos/estimation/configs.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/estimation/gate_watch.hpp"
#include "pos/estimation/imu_track.hpp"
#include "pos/estimation/inertial_filters.hpp"
#include "pos/estimation/inertial_intake.hpp"
#include "pos/estimation/late_replay.hpp"
#include "pos/estimation/uwb_epoch.hpp"
#include "pos/estimation/uwb_links.hpp"

namespace pos::estimation {

/// The part of the configuration that tells which links there are.
DualUwbConfig linksOf(const UwbImuConfig& config);
/// What watches for all anchors being rejected.
GateConfig watchOf(const RecoveryConfig& recovery);
/// The belief of an inertial unit that drives: level, heading and position as given.
Belief<EskfState> movingStart(const UwbImuConfig& config, const Belief<Pose2>& at);
/// The belief of one that has stood: level and gyro bias from the average.
Belief<EskfState> restedStart(const UwbImuConfig& config, const Belief<Pose2>& at,
                              const ins::RestAverage& average, bool rested);
/// The pose of the body whose inertial unit sits at `imu` (m, body).
Estimate bodyEstimate(Stamp stamp, const Belief<EskfState>& belief, const Eigen::Vector3d& imu);

/// One of the three filters with everything round it. Copyable; LateReplay makes an Estimator of it.
template <class Filter>
class UwbImuCore {
 public:
  UwbImuCore(const UwbImuConfig& config, const std::shared_ptr<const map::TunnelMap>& map);

  void reset(Stamp stamp, const Belief<Pose2>& prior);
  IngestReport ingest(const Measurement& measurement);
  std::optional<Estimate> estimateAt(Stamp stamp) const;
  Diagnostics diagnostics() const;

  /// The whole state; for tests. Nothing before the start.
  const std::optional<Filter>& filter() const { return filter_; }

 private:
  IngestReport take(Stamp stamp, const ImuSample& sample);
  IngestReport take(Stamp stamp, const BeaconRange& range);
  IngestReport take(Stamp stamp, const PassageFix& fix);
  IngestReport take(Stamp stamp, const WheelSpeeds& speeds) {
    return roll(stamp, wheels_.take(stamp, speeds));
  }
  IngestReport take(Stamp stamp, const WheelTicks& ticks) { return roll(stamp, wheels_.take(stamp, ticks)); }
  template <class Other>
  IngestReport take(Stamp, const Other&) {
    return {.verdict = Verdict::Unsupported, .reason = "uwb_imu has no use for this kind of reading"};
  }
  IngestReport roll(Stamp stamp, const WheelIntake::Told& told);

  Belief<Pose2> prior() const;
  IngestReport align(Stamp stamp, const ins::ImuIncrement& raw);
  IngestReport notStarted() const;
  void start(Stamp stamp, const Belief<EskfState>& belief);
  static void apply(Filter& filter, const ImuTrack::Share& share);
  void carryTo(Stamp stamp);
  void aid(Stamp stamp);
  IngestReport weigh(Stamp stamp, const RangeLink& link, double sigma);
  void recover(double innovation);

  UwbImuConfig config_;
  ins::EskfProcess process_;
  UwbLinks links_;
  std::optional<Filter> filter_;
  std::optional<Belief<Pose2>> given_;  // by reset
  std::optional<Stamp> state_stamp_;
  std::optional<Stamp> last_stamp_;

  ImuIntake imu_;
  ImuTrack track_;
  ins::StandstillDetector standstill_;
  RestAlignment rest_;
  ins::RestAverage rate_;  // readings since the last aid
  std::optional<Stamp> aided_;
  WheelIntake wheels_;

  GateWatch watch_;
  AnchorDoubts doubts_;
  int recoveries_ = 0;
  int rejected_ = 0;
  int doubted_ = 0;
  double last_nis_ = 0.0;
};

extern template class UwbImuCore<EskfFilter>;
extern template class UwbImuCore<AdditiveEkf>;
extern template class UwbImuCore<ManifoldUkf>;

/// A fix of its own for each epoch of one tag's ranges; the heading is the start's, or unknown.
class UwbOnlyCore {
 public:
  UwbOnlyCore(const UwbImuConfig& config, std::shared_ptr<const map::TunnelMap> map);

  void reset(Stamp stamp, const Belief<Pose2>& prior);
  IngestReport ingest(const Measurement& measurement);
  std::optional<Estimate> estimateAt(Stamp stamp) const;
  Diagnostics diagnostics() const;

 private:
  struct Fix {
    Stamp stamp;
    Eigen::Vector2d p_map;  // of the body, m
    Matrix<2, 2> covariance;
  };
  IngestReport take(Stamp stamp, const BeaconRange& range);
  std::optional<Fix> solved() const;

  UwbImuConfig config_;
  UwbLinks links_;
  uwb::ResidualTest test_;
  UwbEpoch epoch_;
  std::optional<Fix> fix_;
  Belief<Pose2> prior_;
  std::optional<Stamp> last_stamp_;
  bool counted_ = false;
  int epochs_ = 0;
  int held_ = 0;
};

/// The estimator that the configuration describes.
std::unique_ptr<Estimator> makeUwbImu(const UwbImuConfig& config,
                                      const std::shared_ptr<const map::TunnelMap>& map);

}  // namespace pos::estimation
