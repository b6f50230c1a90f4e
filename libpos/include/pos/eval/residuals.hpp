#pragma once
/// Range residuals (innovation = range - prediction) per anchor, in bounded memory.

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "pos/core/evenly_spread.hpp"
#include "pos/core/measurement.hpp"
#include "pos/core/verdict.hpp"

namespace pos::eval {

struct ResidualSample {
  Stamp stamp;
  double residual = 0.0;  ///< m
  double sigma = 0.0;     ///< m, what the filter expected
  bool applied = false;
};

/// Figures of one set of residuals, m.
struct ResidualFigures {
  std::uint64_t count = 0;
  double mean = 0.0;
  double std = 0.0;
  double median = 0.0;
  double mad_sigma = 0.0;  ///< 1.4826 * median absolute deviation: the spread that outliers do not move
};

struct AnchorResiduals {
  AnchorId anchor = 0;
  ResidualFigures applied;
  ResidualFigures all;
  std::vector<ResidualSample> samples;  ///< in time order, thinned
};

/// Collects scalar innovations. Count, mean and std are of all readings. The samples kept for median, MAD and
/// plots are every 2^k-th one, k growing so that at most `capacity` per anchor are held: the choice depends
/// on the order of the readings alone, so that a rerun keeps the same ones.
class ResidualCollector {
 public:
  explicit ResidualCollector(std::size_t capacity = 2000) : capacity_(capacity) {}

  /// Takes the report of a range; one without a scalar innovation (dof != 1) changes nothing.
  void add(AnchorId anchor, Stamp stamp, const IngestReport& report);

  /// Per anchor, ids upward.
  std::vector<AnchorResiduals> summary() const;

 private:
  struct Moments {
    std::uint64_t count = 0;
    double mean = 0.0;
    double squares = 0.0;  ///< sum of squared deviations from the mean (Welford 1962)
    void add(double value);
  };
  struct Entry {
    Moments applied = {};
    Moments all = {};
    EvenlySpread<ResidualSample> samples;
  };
  static ResidualFigures figures(const Moments& moments, std::vector<double> values);

  std::size_t capacity_;
  std::map<AnchorId, Entry> entries_;
};

}  // namespace pos::eval
