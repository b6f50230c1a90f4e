#pragma once
/// Notices when the readings stop fitting the particles.

#include <vector>

#include "pos/core/stamp.hpp"
#include "pos/filters/recovery.hpp"

namespace pos::estimation {

/// Running means of the likelihood of ranges (the median of each stamp's ranges, so that one bad anchor does
/// not count) and of scans (per independent beam). Gated readings count too.
class LostDetector {
 public:
  LostDetector(double slow_rate, double fast_rate)
      : ranges_(slow_rate, fast_rate), scans_(slow_rate, fast_rate) {}

  void noteRange(Stamp stamp, double evidence);  ///< 1/m
  void noteScan(double likelihood_per_beam) { scans_.add(likelihood_per_beam); }
  /// No more ranges of the present stamp will come.
  void settle();

  /// Share of the particles to draw anew, 0 .. 1. Where both kinds of reading are in use, both must ask for
  /// it. A share below one half is normal wavering of the likelihood and counts as none.
  double share() const;
  bool lost() const { return share() > 0.0; }

 private:
  filters::LikelihoodAverages ranges_;
  filters::LikelihoodAverages scans_;
  Stamp stamp_;
  std::vector<double> evidence_;  // of the ranges of stamp_
};

}  // namespace pos::estimation
