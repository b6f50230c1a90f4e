#pragma once
/// Summary figures of a list of errors. One definition for every table, file and plot:
///
///   rmse = sqrt(mean of e^2)        mean = signed mean        std = sqrt(rmse^2 - mean^2) (divided by n)
///   median, min, max, p50 .. p99 = of |e|; a percentile is interpolated linearly between the two
///   neighbouring sorted values at position p * (n - 1)
///
/// For an error that cannot be negative (xy distance) |e| = e.

#include <cstddef>
#include <vector>

namespace pos::eval {

struct Statistics {
  std::size_t count = 0;  ///< 0: all other fields are 0 and mean nothing
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double std = 0.0;
  double min = 0.0;
  double max = 0.0;
  double p50 = 0.0;
  double p68 = 0.0;
  double p90 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
};

/// Figures of `errors` as defined above. O(n log n).
Statistics statistics(const std::vector<double>& errors);

/// Percentile of values sorted upward; 0 <= probability <= 1; at least one value (ContractError).
double sortedQuantile(const std::vector<double>& sorted, double probability);

/// Share of the values with |value| < limit; 0 for an empty list.
double fractionUnder(const std::vector<double>& values, double limit);

/// One point of a cumulative distribution: `fraction` of the values lie at or below `value`.
struct CdfPoint {
  double value = 0.0;
  double fraction = 0.0;
};

/// Distribution of |value| at `points` evenly spaced fractions from 0 to 1 (fewer values: every value).
std::vector<CdfPoint> cumulativeDistribution(const std::vector<double>& values, std::size_t points);

}  // namespace pos::eval
