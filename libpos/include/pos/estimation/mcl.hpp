#pragma once
/// Particle filter on beacon ranges and laser scans ("Monte Carlo localisation"), in the plane.
/// docs/math/mcl.md has the equations.
///
/// Takes odometry increments (its own noise model, not the log's covariance), ranges to the map's anchors and
/// scans against the map's grid. Readings of one stamp are weighed as they come and share one resampling,
/// done when the next motion or stamp arrives. Cost O(particles) a range, O(particles * beams) a scan.
///
/// Verdicts: Unsupported (kinds not used), Degenerate (bad reading, unknown anchor, scan without a usable
/// beam), NotInitialised (no start yet), TooOld (before the state's stamp), Gated (a reading that is an
/// outlier to the whole cloud; the belief stays as it was, but enough of them make the filter look
/// elsewhere).

#include <memory>
#include <optional>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/estimation/anchor_table.hpp"
#include "pos/estimation/configs.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/estimation/lost_detector.hpp"
#include "pos/estimation/particle_start.hpp"
#include "pos/estimation/range_likelihood.hpp"
#include "pos/estimation/scan_weights.hpp"
#include "pos/filters/kld.hpp"
#include "pos/filters/particle_set.hpp"
#include "pos/filters/resampling.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation {

class Mcl : public Estimator {
 public:
  /// Throws ConfigError when the map lacks what the config uses (anchors, a grid) or a number is out of
  /// range.
  Mcl(const MclConfig& config, std::shared_ptr<const map::TunnelMap> map);

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  /// Weighted mean and covariance of the particles at the state's stamp; for a later stamp the same,
  /// restamped.
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  /// particles, effective_size, injected_share, and where tracked one range_offset_m per anchor.
  Diagnostics diagnostics() const override;

  const filters::ParticleSet& particles() const { return set_; }

 private:
  /// Readings of one stamp that have been weighed and not yet resampled.
  struct Group {
    Stamp stamp;
    std::vector<RangeTerm> ranges;
    std::vector<lidar::BeamPoints> scans;
    std::vector<double> exponents;  // one per scan
  };

  bool started() const { return set_.size() > 0; }
  IngestReport take(const OdometryIncrement& odometry, Stamp stamp);
  IngestReport take(const BeaconRange& range, Stamp stamp);
  IngestReport take(const Scan2D& scan, Stamp stamp);
  template <class Other>
  IngestReport take(const Other&, Stamp) {
    return {.verdict = Verdict::Unsupported, .reason = "the particle filter has no use for this kind"};
  }
  template <class R>
  bool uses() const;

  RangeTerm rangeTerm(const BeaconRange& range, const AnchorTable::Entry& entry, const RangeBias& bias) const;
  Eigen::Vector3d tagPosition(const BeaconRange& range) const;
  double exponent(const std::optional<double>& last_odometer, double correlation_length) const;
  void startAt(Stamp stamp);
  void startOnRing(Stamp stamp, const RangeTerm& term);
  filters::ParticleSet particlesOnRing(const RangeTerm& term, std::size_t count);
  RandomStream& fresh();

  const filters::HeadingTable& headings();
  void openGroup(Stamp stamp);
  void closeGroup();
  std::size_t wantedCount();
  void inject(double share, double log_evidence);
  filters::ParticleSet newcomers(std::size_t count);
  void weighByGroup(filters::ParticleSet& set);

  MclConfig config_;
  std::shared_ptr<const map::TunnelMap> map_;
  AnchorTable anchors_;
  FreeSpace free_space_;
  std::optional<ScanWeights> scan_weights_;
  RangeWeights range_weights_;
  filters::SystematicResampler resampler_;
  filters::BinCounter bins_;
  RandomStream stream_;

  filters::ParticleSet set_;  // empty = not initialised
  Stamp stamp_;
  std::uint64_t step_ = 0;  // counts motions: every one has its own random numbers
  std::optional<Stamp> last_odometry_;
  double odometer_ = 0.0;                // m driven
  std::optional<double> scan_odometer_;  // where the last scan was applied
  std::optional<Group> group_;
  filters::HeadingTable headings_;
  bool headings_fresh_ = false;

  LostDetector lost_;
  double injected_share_ = 0.0;
};

}  // namespace pos::estimation
