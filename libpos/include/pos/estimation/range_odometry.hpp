#pragma once
/// `range_odometry`: planar EKF on odometry (or constant velocity) and ranges to surveyed anchors, with the
/// radio's scale, offsets and latency and the odometry's gyro bias and scale estimated on the way. Passage
/// fixes (position with its covariance, heading where given) correct it too. docs/math/range_odometry.md
/// walks through it in the order of this code.

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>

#include "pos/estimation/estimator.hpp"
#include "pos/estimation/gate_watch.hpp"
#include "pos/estimation/range_bank.hpp"
#include "pos/estimation/range_start.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation {

class RangeOdometry final : public Estimator {
 public:
  /// Throws ConfigError when the map has no anchors or the configuration does not fit them.
  RangeOdometry(const RangeOdometryConfig& config, std::shared_ptr<const map::TunnelMap> map);

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  Diagnostics diagnostics() const override;

 private:
  IngestReport take(Stamp stamp, const OdometryIncrement& odometry);
  IngestReport take(Stamp stamp, const BeaconRange& range);
  IngestReport take(Stamp stamp, const PassageFix& fix);
  template <class Other>
  IngestReport take(Stamp, const Other&) {
    return {.verdict = Verdict::Unsupported, .reason = "range_odometry has no use for this kind of reading"};
  }

  bool driven() const { return config_.motion == RangeOdometryConfig::Motion::Odometry; }
  void begin(Stamp stamp);
  void restart(Stamp stamp);
  Belief<RangeState> carried(Belief<RangeState> belief, double dt) const;
  void carryTo(Stamp stamp);
  double ageOf(Stamp stamp) const;
  BodyVelocity coasting(double age) const;
  std::optional<RangeGeometry> geometryOf(const BeaconRange& range, double age) const;
  IngestReport gather(Stamp stamp, const BeaconRange& range);
  IngestReport correct(Stamp stamp, const BeaconRange& range, const RangeGeometry& geometry);
  double unknownMotion(double age) const;
  std::string_view openGate(Stamp stamp);

  RangeOdometryConfig config_;
  std::shared_ptr<const map::TunnelMap> map_;
  std::unordered_map<AnchorId, map::Anchor> anchors_;
  RangeLayout layout_;
  filters::Gate gate_;
  GateWatch watch_;
  RangeBank bank_;
  std::optional<RangeStart> start_;  // gathering, while the first pose is not known
  std::optional<Stamp> state_stamp_;
  std::optional<Stamp> last_stamp_;
  std::optional<Stamp> odometry_stamp_;
  BodyVelocity odometry_velocity_;
  double odometry_interval_ = 0.0;
  int gate_openings_ = 0;
  int restarts_ = 0;
};

}  // namespace pos::estimation
