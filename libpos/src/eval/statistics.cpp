#include "pos/eval/statistics.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"

namespace pos::eval {

namespace {

std::vector<double> sortedMagnitudes(const std::vector<double>& values) {
  std::vector<double> sorted(values.size());
  std::transform(values.begin(), values.end(), sorted.begin(), [](double v) { return std::abs(v); });
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

double meanOf(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

}  // namespace

double sortedQuantile(const std::vector<double>& sorted, double probability) {
  ensure(!sorted.empty(), "a percentile needs at least one value");
  const double position = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  if (below + 1 >= sorted.size()) return sorted.back();
  const double part = position - static_cast<double>(below);
  return (1.0 - part) * sorted[below] + part * sorted[below + 1];
}

Statistics statistics(const std::vector<double>& errors) {
  Statistics s;
  if (errors.empty()) return s;
  const double n = static_cast<double>(errors.size());
  s.count = errors.size();
  s.mean = meanOf(errors);
  double squares = 0.0;
  double deviations = 0.0;
  for (const double e : errors) {
    squares += e * e;
    deviations += (e - s.mean) * (e - s.mean);
  }
  s.rmse = std::sqrt(squares / n);
  s.std = std::sqrt(deviations / n);
  const std::vector<double> sorted = sortedMagnitudes(errors);
  s.min = sorted.front();
  s.max = sorted.back();
  s.p50 = sortedQuantile(sorted, 0.50);
  s.median = s.p50;
  s.p68 = sortedQuantile(sorted, 0.68);
  s.p90 = sortedQuantile(sorted, 0.90);
  s.p95 = sortedQuantile(sorted, 0.95);
  s.p99 = sortedQuantile(sorted, 0.99);
  return s;
}

double fractionUnder(const std::vector<double>& values, double limit) {
  if (values.empty()) return 0.0;
  const auto under =
      std::count_if(values.begin(), values.end(), [limit](double v) { return std::abs(v) < limit; });
  return static_cast<double>(under) / static_cast<double>(values.size());
}

std::vector<CdfPoint> cumulativeDistribution(const std::vector<double>& values, std::size_t points) {
  std::vector<CdfPoint> cdf;
  if (values.empty()) return cdf;
  const std::vector<double> sorted = sortedMagnitudes(values);
  if (sorted.size() <= points || points < 2) {
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      cdf.push_back({sorted[i], static_cast<double>(i + 1) / static_cast<double>(sorted.size())});
    }
    return cdf;
  }
  for (std::size_t i = 0; i < points; ++i) {
    const double fraction = static_cast<double>(i) / static_cast<double>(points - 1);
    cdf.push_back({sortedQuantile(sorted, fraction), fraction});
  }
  return cdf;
}

}  // namespace pos::eval
