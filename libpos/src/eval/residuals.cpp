#include "pos/eval/residuals.hpp"

#include <algorithm>
#include <cmath>

#include "pos/eval/statistics.hpp"

namespace pos::eval {

namespace {

/// Scale that makes the median absolute deviation of a normal distribution its sigma.
constexpr double kMadToSigma = 1.4826022185056018;

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return sortedQuantile(values, 0.5);
}

}  // namespace

void ResidualCollector::Moments::add(double value) {
  ++count;
  const double before = value - mean;
  mean += before / static_cast<double>(count);
  squares += before * (value - mean);
}

void ResidualCollector::add(AnchorId anchor, Stamp stamp, const IngestReport& report) {
  if (report.dof != 1 || !std::isfinite(report.innovation)) return;
  Entry& entry =
      entries_.try_emplace(anchor, Entry{.samples = EvenlySpread<ResidualSample>(capacity_)}).first->second;
  const bool applied = report.verdict == Verdict::Applied;
  entry.all.add(report.innovation);
  if (applied) entry.applied.add(report.innovation);
  entry.samples.add({stamp, report.innovation, report.innovation_sigma, applied});
}

ResidualFigures ResidualCollector::figures(const Moments& moments, std::vector<double> values) {
  ResidualFigures f;
  f.count = moments.count;
  if (moments.count == 0) return f;
  f.mean = moments.mean;
  f.std = std::sqrt(moments.squares / static_cast<double>(moments.count));
  if (values.empty()) return f;
  f.median = medianOf(values);
  for (double& v : values) v = std::abs(v - f.median);
  f.mad_sigma = kMadToSigma * medianOf(std::move(values));
  return f;
}

std::vector<AnchorResiduals> ResidualCollector::summary() const {
  std::vector<AnchorResiduals> all;
  for (const auto& [anchor, entry] : entries_) {
    std::vector<double> every;
    std::vector<double> applied;
    for (const ResidualSample& sample : entry.samples.kept()) {
      every.push_back(sample.residual);
      if (sample.applied) applied.push_back(sample.residual);
    }
    all.push_back({anchor, figures(entry.applied, std::move(applied)), figures(entry.all, std::move(every)),
                   entry.samples.kept()});
  }
  return all;
}

}  // namespace pos::eval
