#include "pos/eval/consistency.hpp"

#include <algorithm>
#include <cmath>

namespace pos::eval {

namespace {

constexpr double kConfidence = 0.95;
constexpr std::size_t kMostBlocks = 2000;

double meanOf(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// Autocovariance at `lag`, divided by n.
double autocovariance(const std::vector<double>& values, double mean, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = 0; i + lag < values.size(); ++i) sum += (values[i] - mean) * (values[i + lag] - mean);
  return sum / static_cast<double>(values.size());
}

/// Means of equally long blocks; a rest shorter than a block is left out.
std::vector<double> blockMeans(const std::vector<double>& values, std::size_t length) {
  std::vector<double> means;
  for (std::size_t i = 0; i + length <= values.size(); i += length) {
    double sum = 0.0;
    for (std::size_t k = 0; k < length; ++k) sum += values[i + k];
    means.push_back(sum / static_cast<double>(length));
  }
  return means;
}

/// Variance of the mean of a correlated series: Geyer's initial positive sequence.
double varianceOfMean(const std::vector<double>& values) {
  const double mean = meanOf(values);
  const double variance = autocovariance(values, mean, 0);
  double sum = -variance;
  for (std::size_t lag = 0; lag + 1 < values.size(); lag += 2) {
    const double pair = autocovariance(values, mean, lag) + autocovariance(values, mean, lag + 1);
    if (pair <= 0.0) break;
    sum += 2.0 * pair;
  }
  return std::max(sum, 0.0) / static_cast<double>(values.size());
}

std::vector<double> present(const ErrorSeries& series, std::optional<double> ErrorSample::*field) {
  std::vector<double> all;
  for (const ErrorSample& sample : series) {
    if (sample.*field) all.push_back(*(sample.*field));
  }
  return all;
}

}  // namespace

Honesty NeesSummary::honesty() const {
  if (count == 0) return Honesty::Unknown;
  if (mean > bounds.high) return Honesty::TooSure;
  return mean < bounds.low ? Honesty::TooCautious : Honesty::Consistent;
}

double NeesSummary::sigmaFactor() const {
  return count == 0 ? 1.0 : std::sqrt(mean / static_cast<double>(dof));
}

double NeesSummary::explainingTruthSigma(double rmse_xy) const {
  const double factor = sigmaFactor();
  return factor > 1.0 ? rmse_xy * std::sqrt(0.5 * (1.0 - 1.0 / (factor * factor))) : 0.0;
}

double effectiveSampleSize(const std::vector<double>& series) {
  const double n = static_cast<double>(series.size());
  if (series.size() < 2) return n;
  const double variance = autocovariance(series, meanOf(series), 0);
  if (variance <= 0.0) return 1.0;
  const std::size_t block = (series.size() + kMostBlocks - 1) / kMostBlocks;
  const double variance_of_mean = varianceOfMean(blockMeans(series, block));
  if (variance_of_mean <= variance / n) return n;
  return std::max(1.0, variance / variance_of_mean);
}

NeesSummary neesSummary(const std::vector<double>& nees, int dof) {
  NeesSummary summary;
  summary.dof = dof;
  summary.count = nees.size();
  if (nees.empty()) return summary;
  summary.mean = meanOf(nees);
  summary.effective_count = effectiveSampleSize(nees);
  summary.bounds = meanChiSquareBounds(kConfidence, dof, summary.effective_count);
  summary.naive_bounds = meanChiSquareBounds(kConfidence, dof, static_cast<double>(nees.size()));
  return summary;
}

std::optional<double> fractionInside3Sigma(const ErrorSeries& series, Component which) {
  std::size_t known = 0;
  std::size_t inside = 0;
  for (const ErrorSample& sample : series) {
    const auto error = component(sample, which);
    if (!error || error->sigma <= 0.0) continue;
    ++known;
    if (std::abs(error->value) <= 3.0 * error->sigma) ++inside;
  }
  if (known == 0) return std::nullopt;
  return static_cast<double>(inside) / static_cast<double>(known);
}

Consistency consistency(const ErrorSeries& series) {
  Consistency c;
  c.nees_xy = neesSummary(present(series, &ErrorSample::nees_xy), 2);
  c.nees_pose = neesSummary(present(series, &ErrorSample::nees_pose), 3);
  c.without_covariance = series.size() - c.nees_xy.count;
  c.inside_x = fractionInside3Sigma(series, Component::X);
  c.inside_y = fractionInside3Sigma(series, Component::Y);
  c.inside_along = fractionInside3Sigma(series, Component::Along);
  c.inside_cross = fractionInside3Sigma(series, Component::Cross);
  c.inside_yaw = fractionInside3Sigma(series, Component::Yaw);
  return c;
}

}  // namespace pos::eval
