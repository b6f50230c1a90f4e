#pragma once
/// MRPT's own particle filter behind our interface, to measure ours against: CMonteCarloLocalization2D with
/// CParticleFilter (standard proposal, systematic resampling, or multinomial where the size is adaptive),
/// CBeaconMap for ranges and COccupancyGridMap2D's likelihood field for scans, all at MRPT's defaults but for
/// what MrptMclConfig names.

#include <memory>

#include "pos/estimation/configs.hpp"
#include "pos/estimation/estimator.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::yardstick {

/// Repeatable: MRPT draws from one random generator per thread, which every call here exchanges for the
/// instance's own and puts back.
///
/// Verdicts: Unsupported (kinds not used), Degenerate (bad reading, unknown anchor), TooOld, NotInitialised
/// (odometry before the start). MRPT knows no gate: everything else is Applied.
class MrptMcl : public estimation::Estimator {
 public:
  /// Throws ConfigError when the map lacks what the config uses or a number is out of range.
  MrptMcl(const estimation::MrptMclConfig& config, std::shared_ptr<const map::TunnelMap> map);
  ~MrptMcl() override;

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  /// MRPT's mean and covariance at the state's stamp; for a later stamp the same, restamped.
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  /// particles, effective_size.
  Diagnostics diagnostics() const override;

 private:
  struct Filter;
  std::unique_ptr<Filter> filter_;
};

}  // namespace pos::yardstick
