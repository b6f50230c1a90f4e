#pragma once
/// The anchors a particle filter knows, each with the slowly varying offset of its ranges.

#include <map>

#include "pos/estimation/configs.hpp"
#include "pos/estimation/range_likelihood.hpp"
#include "pos/map/tunnel_map.hpp"

namespace pos::estimation {

/// Offset of one anchor's ranges: a first-order Gauss-Markov process, b <- b exp(-dt / T), with the steady
/// standard deviation `bias_sigma`. Tracked beside the particles (one for all of them), not within each.
struct RangeBias {
  double mean = 0.0;      ///< m
  double variance = 0.0;  ///< m^2
};

/// `bias` after `dt` seconds.
RangeBias predicted(const RangeBias& bias, const RangeLikelihood& model, double dt);
/// `bias` after a range whose innovation about the cloud's mean (this bias taken off) is `nu`. The share of
/// an outlier counts for nothing (probabilistic data association with one candidate).
RangeBias corrected(const RangeBias& bias, const RangeTerm& term, const RangeSums& sums);

class AnchorTable {
 public:
  AnchorTable(const map::TunnelMap& map, const RangeLikelihood& model);

  struct Entry {
    map::Anchor anchor;
    RangeBias bias;
    std::optional<Stamp> last;       ///< when a range to it was last applied
    std::optional<double> odometer;  ///< m, and where
  };
  /// Null for an id the map does not have.
  const Entry* find(AnchorId id) const;
  /// The entry's bias at `stamp`.
  RangeBias biasAt(const Entry& entry, Stamp stamp) const;
  /// A range to this anchor was applied.
  void note(AnchorId id, Stamp stamp, double odometer, const RangeBias& bias);
  void reset();
  const std::map<AnchorId, Entry>& entries() const { return entries_; }

 private:
  RangeLikelihood model_;
  std::map<AnchorId, Entry> entries_;
};

}  // namespace pos::estimation
