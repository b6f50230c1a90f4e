#pragma once
/// `dual_uwb`, variants `filter` and `filter_gyro`: a Kalman filter on the raw ranges of two or more tags,
/// each at its own stamp (spec A, section 2.6; docs/math/dual_uwb.md).

#include <memory>
#include <vector>

#include "pos/estimation/anchor_watch.hpp"
#include "pos/estimation/dual_uwb_bank.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/estimation/uwb_epoch.hpp"
#include "pos/estimation/uwb_links.hpp"

namespace pos::estimation {

class DualUwbFilter : public Estimator {
 public:
  /// Throws ConfigError when the map has no anchors or the links do not fit into the state.
  DualUwbFilter(const DualUwbConfig& config, std::shared_ptr<const map::TunnelMap> map);

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  Diagnostics diagnostics() const override;

 private:
  IngestReport take(Stamp stamp, const BeaconRange& range);
  IngestReport take(Stamp stamp, const ImuSample& imu);
  IngestReport take(Stamp stamp, const WheelSpeeds& wheels);
  template <class Reading>
  IngestReport take(Stamp, const Reading&) {
    return {.verdict = Verdict::Unsupported, .reason = "dual_uwb takes ranges, a gyro and wheel speeds"};
  }

  void begin(Stamp stamp);
  IngestReport gather(Stamp stamp, const UwbReading& reading);
  void start(Stamp stamp, const uwb::RigidFixes& fixes);
  Belief<DualUwbState> startBelief(const Belief<Pose2>& pose) const;
  void forget();
  void restart();

  void carryTo(Stamp stamp);
  DualUwbStep stepTo(const DualUwbState& x, Stamp stamp) const;
  Belief<DualUwbState> carried(Belief<DualUwbState> belief, Stamp stamp) const;
  GyroInput gyroAt(Stamp stamp) const;
  IngestReport correctRange(Stamp stamp, const UwbReading& reading);
  filters::Correction<1> corrected(const UwbReading& reading);
  void holdCourse(Stamp stamp);
  bool allDisagree(Stamp stamp, Verdict verdict);
  void doubtVelocity(Stamp stamp);
  std::string_view wheelsAtOdds(Stamp stamp, double speed);
  void settle(Stamp stamp);
  std::string_view alarm(Stamp stamp);
  bool backwards(const DualUwbHypothesis& hypothesis, Stamp stamp) const;

  DualUwbConfig config_;
  RoadwayTest roadway_;
  UwbLinks links_;
  DualUwbLayout layout_;
  filters::Gate gate_;
  uwb::ResidualTest residual_test_;
  AnchorWatch watch_;

  DualUwbBank bank_;
  UwbEpoch early_;  // ranges gathered for the first pose
  int attempts_ = 0;
  std::optional<Stamp> state_stamp_;
  std::optional<Stamp> last_stamp_;
  std::optional<Stamp> still_until_;
  std::optional<Stamp> gyro_stamp_;
  double gyro_rate_ = 0.0;
  std::optional<Stamp> course_held_;
  std::optional<Stamp> backwards_since_;
  std::optional<Stamp> applied_stamp_;  // of the last range that passed
  int rejected_in_row_ = 0;
  std::optional<Stamp> at_odds_since_;  // half of the anchors disagree while the wheels turn
  bool alarmed_ = false;
  int restarts_ = 0;
  int blockings_ = 0;
  int alarms_ = 0;
  int doubts_ = 0;
};

}  // namespace pos::estimation
