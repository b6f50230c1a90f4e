#pragma once
/// `seamless`: from the surface to the underground without a gap. Satellites and inertial unit in one filter,
/// radio ranges and the same inertial unit in another, mixed as interacting models, with or without a fuzzy
/// controller (J. China Coal Soc. 2024, doi 10.13225/j.cnki.jccs.2024.0676, corrected).
/// docs/math/seamless.md walks through it.

#include <map>
#include <memory>
#include <optional>

#include "pos/estimation/estimator.hpp"
#include "pos/estimation/inertial_intake.hpp"
#include "pos/estimation/portal_zones.hpp"
#include "pos/estimation/seamless_core.hpp"
#include "pos/map/geodesy.hpp"

namespace pos::estimation {

class Seamless final : public Estimator {
 public:
  Seamless(const SeamlessConfig& config, const std::shared_ptr<const map::TunnelMap>& map);

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  Diagnostics diagnostics() const override;

 private:
  IngestReport take(Stamp stamp, const ImuSample& sample);
  IngestReport take(Stamp stamp, const GnssFix& fix);
  IngestReport take(Stamp stamp, const BeaconRange& range);
  template <class Other>
  IngestReport take(Stamp, const Other&) {
    return {.verdict = Verdict::Unsupported, .reason = "seamless has no use for this kind of reading"};
  }

  Belief<Pose2> prior() const;
  IngestReport align(Stamp stamp, const ins::ImuIncrement& raw);
  void start(Stamp stamp);
  /// Carries the filters to a stamp between two samples of the unit, as if the last one went on.
  std::string_view advance(Stamp stamp);
  void aid(Stamp stamp);
  /// Why satellites are left out here; empty where they are not.
  std::string_view masked(const GnssFix& fix) const;
  /// The best belief now, and its covariance of the body's place.
  double alongSigma(const Belief<EskfState>& belief) const;
  Eigen::Vector3d bodyPlace(const EskfState& x) const;

  SeamlessConfig config_;
  std::map<AnchorId, map::Anchor> anchors_;
  PortalZones zones_;
  std::optional<map::LocalFrame> frame_;

  SeamlessCore core_;
  bool running_ = false;
  std::optional<Belief<Pose2>> given_;  // by reset
  std::optional<Stamp> last_stamp_;
  ImuIntake imu_;
  ins::StandstillDetector standstill_;
  RestAlignment rest_;
  ins::ImuIncrement last_sample_;  // biases and all
  ins::ImuIncrement ahead_;        // what of the next sample was taken in advance
  std::optional<Stamp> aided_;
};

}  // namespace pos::estimation
