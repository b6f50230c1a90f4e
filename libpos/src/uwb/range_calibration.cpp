#include "pos/uwb/range_calibration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "pos/uwb/rigid.hpp"

namespace pos::uwb {
namespace {

constexpr int kRounds = 4;
constexpr double kLeastSigma = 0.005;  // m, of a range; keeps perfect data from being split into outliers
constexpr double kLater = 1.0;         // s, after which it is asked what is left of an error
constexpr double kForgotten = 0.05;    // of it: less cannot be told from nothing

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A sample as the fit sees it: what is read too long at the mount, and how that depends on the tag's shift.
struct Row {
  TagId tag;
  std::size_t link;  // index into the links
  double excess;     // m
  Eigen::Vector2d by_shift;
  double weight;  // share of an independent reading
  bool kept = true;
};

Row rowOf(const CalibrationSample& s, std::size_t link) {
  const RangeRow predicted = predictedRange(s.pose, s.body_height, s.tag_body, s.anchor_map);
  const Eigen::Vector2d towards_tag_map = predicted.row.head<2>();
  return {s.tag, link, s.range - predicted.distance, rotation2(s.pose.yaw).transpose() * towards_tag_map,
          1.0};
}

using LinkKey = std::pair<TagId, AnchorId>;

std::vector<LinkCalibration> linksOf(std::span<const CalibrationSample> samples,
                                     std::map<LinkKey, std::size_t>& index) {
  for (const CalibrationSample& s : samples) index.emplace(LinkKey{s.tag, s.anchor}, 0);
  std::vector<LinkCalibration> links;
  for (auto& [key, place] : index) {
    place = links.size();
    links.push_back({.tag = key.first, .anchor = key.second});
  }
  return links;
}

std::vector<Row> rowsOf(std::span<const CalibrationSample> samples,
                        const std::map<LinkKey, std::size_t>& index, double correlation_time) {
  std::vector<Row> rows;
  std::map<std::pair<std::size_t, std::int64_t>, int> bins;
  const auto bin = [&](std::size_t i) {
    const double age = seconds(samples[i].stamp - samples.front().stamp);
    const auto number = correlation_time > 0.0 ? static_cast<std::int64_t>(std::floor(age / correlation_time))
                                               : static_cast<std::int64_t>(i);
    return std::pair{rows[i].link, number};
  };
  for (const CalibrationSample& s : samples) rows.push_back(rowOf(s, index.at({s.tag, s.anchor})));
  for (std::size_t i = 0; i < rows.size(); ++i) ++bins[bin(i)];
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].weight = 1.0 / bins[bin(i)];
  return rows;
}

/// Links of one tag are neighbours: `first` to `last`, the shift before them.
struct TagBlock {
  TagId tag;
  std::size_t first;
  std::size_t last;
};

std::vector<TagBlock> blocksOf(const std::vector<LinkCalibration>& links) {
  std::vector<TagBlock> blocks;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (blocks.empty() || blocks.back().tag != links[i].tag) blocks.push_back({links[i].tag, i, i});
    blocks.back().last = i + 1;
  }
  return blocks;
}

/// Shift and biases of one tag, given the sigma of a range and the biases' common mean.
TagCalibration solveTag(const TagBlock& block, const std::vector<Row>& rows, double sigma, double common,
                        const CalibrationOptions& options, std::vector<LinkCalibration>& links) {
  const auto n = static_cast<Eigen::Index>(2 + block.last - block.first);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  const double shift_sigma = std::max(options.shift_sigma, 1e-9);
  A.diagonal().head<2>().setConstant(1.0 / (shift_sigma * shift_sigma));
  A.diagonal().tail(n - 2).setConstant(1.0 / (options.bias_spread * options.bias_spread));
  b.tail(n - 2).setConstant(common / (options.bias_spread * options.bias_spread));
  for (const Row& row : rows) {
    if (!row.kept || row.tag != block.tag) continue;
    const auto k = static_cast<Eigen::Index>(2 + row.link - block.first);
    const double w = row.weight / (sigma * sigma);
    A.topLeftCorner<2, 2>() += w * row.by_shift * row.by_shift.transpose();
    A.col(k).head<2>() += w * row.by_shift;
    A.row(k).head<2>() += w * row.by_shift.transpose();
    A(k, k) += w;
    b.head<2>() += w * row.excess * row.by_shift;
    b[k] += w * row.excess;
  }
  const Eigen::LDLT<Eigen::MatrixXd> factor(A);
  const Eigen::VectorXd x = factor.solve(b);
  const Eigen::MatrixXd P = factor.solve(Eigen::MatrixXd::Identity(n, n));
  for (std::size_t i = block.first; i < block.last; ++i) {
    const auto k = static_cast<Eigen::Index>(2 + i - block.first);
    links[i].bias = x[k];
    links[i].bias_sigma = std::sqrt(P(k, k));
  }
  return {block.tag, x.head<2>(), P.diagonal().head<2>().cwiseSqrt()};
}

double residual(const Row& row, const std::vector<LinkCalibration>& links,
                const std::vector<TagCalibration>& tags) {
  const auto tag =
      std::find_if(tags.begin(), tags.end(), [&](const TagCalibration& t) { return t.tag == row.tag; });
  const double shifted = tag == tags.end() ? 0.0 : row.by_shift.dot(tag->shift);
  return row.excess - links[row.link].bias - shifted;
}

/// Standard deviation that outliers hardly move: 1.4826 times the median of the sizes.
double robustSigma(const std::vector<Row>& rows, const std::vector<LinkCalibration>& links,
                   const std::vector<TagCalibration>& tags) {
  std::vector<double> sizes;
  for (const Row& row : rows) sizes.push_back(std::abs(residual(row, links, tags)));
  return std::max(1.4826 * median(std::move(sizes)), kLeastSigma);
}

void fillStatistics(const std::vector<Row>& rows, RangeCalibration& result) {
  std::vector<double> squares(result.links.size(), 0.0);
  double total = 0.0;
  for (const Row& row : rows) {
    LinkCalibration& link = result.links[row.link];
    ++(row.kept ? link.samples : link.outliers);
    ++(row.kept ? result.samples : result.outliers);
    if (!row.kept) continue;
    const double squared = std::pow(residual(row, result.links, result.tags), 2);
    squares[row.link] += squared;
    total += squared;
  }
  for (std::size_t i = 0; i < squares.size(); ++i) {
    result.links[i].residual_sigma = std::sqrt(squares[i] / std::max(result.links[i].samples, 1));
  }
  result.residual_sigma = std::sqrt(total / std::max(result.samples, 1));
}

/// Mean product of two residuals of one link, and how far they lie apart in time.
struct Lagged {
  double product = 0.0;  ///< m^2
  double lag = 0.0;      ///< s
};

/// Over all pairs of residuals of one link, the second the next one `lag` or more after the first.
Lagged lagged(std::span<const CalibrationSample> samples,
              const std::vector<std::vector<std::size_t>>& by_link, const std::vector<double>& residuals,
              double lag) {
  Lagged sum;
  int count = 0;
  for (const std::vector<std::size_t>& link : by_link) {
    std::size_t later = 0;
    for (std::size_t i = 0; i < link.size(); ++i) {
      const auto apart = [&] { return seconds(samples[link[later]].stamp - samples[link[i]].stamp); };
      for (later = std::max(later, i + 1); later < link.size() && apart() < lag; ++later) continue;
      if (later == link.size()) break;
      if (apart() > 2.0 * std::max(lag, 0.5)) continue;  // a hole in the record
      sum.product += residuals[link[i]] * residuals[link[later]];
      sum.lag += apart();
      ++count;
    }
  }
  if (count == 0) return {};
  return {sum.product / count, sum.lag / count};
}

/// Two neighbouring readings share the lasting part of their errors only, two a second apart what is left of
/// it.
RangeErrors errorsOf(std::span<const CalibrationSample> samples, const std::vector<Row>& rows,
                     const RangeCalibration& found) {
  std::vector<std::vector<std::size_t>> by_link(found.links.size());
  std::vector<double> residuals(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    residuals[i] = residual(rows[i], found.links, found.tags);
    if (rows[i].kept) by_link[rows[i].link].push_back(i);
  }
  const double whole = found.residual_sigma * found.residual_sigma;
  const Lagged next = lagged(samples, by_link, residuals, 0.0);
  const Lagged later = lagged(samples, by_link, residuals, kLater);
  if (next.product <= 0.0) return {.reading_sigma = found.residual_sigma};
  RangeErrors errors;
  double lasting = next.product;
  const double left = std::max(later.product / next.product, kForgotten);
  if (left < 1.0 && later.lag > next.lag) {
    errors.lasting_time = (later.lag - next.lag) / -std::log(left);
    lasting = std::min(whole, lasting * std::exp(next.lag / errors.lasting_time));  // before the next reading
  }
  errors.lasting_sigma = std::sqrt(lasting);
  errors.reading_sigma = std::sqrt(std::max(whole - lasting, 0.0));
  return errors;
}

}  // namespace

RangeCalibration calibratedRanges(std::span<const CalibrationSample> samples,
                                  const CalibrationOptions& options) {
  RangeCalibration result;
  if (samples.empty()) return result;
  std::map<LinkKey, std::size_t> index;
  result.links = linksOf(samples, index);
  std::vector<Row> rows = rowsOf(samples, index, options.correlation_time);
  std::vector<std::vector<double>> excesses(result.links.size());
  std::vector<double> all;
  for (const Row& row : rows) {
    excesses[row.link].push_back(row.excess);
    all.push_back(row.excess);
  }
  const double common = median(std::move(all));
  for (std::size_t i = 0; i < excesses.size(); ++i) result.links[i].bias = median(std::move(excesses[i]));
  for (int round = 0; round < kRounds; ++round) {
    const double sigma = robustSigma(rows, result.links, result.tags);
    for (Row& row : rows)
      row.kept = std::abs(residual(row, result.links, result.tags)) <= options.outlier_sigmas * sigma;
    std::vector<TagCalibration> tags;
    for (const TagBlock& block : blocksOf(result.links)) {
      tags.push_back(solveTag(block, rows, sigma, common, options, result.links));
    }
    if (options.shift_sigma > 0.0) result.tags = std::move(tags);
  }
  fillStatistics(rows, result);
  result.errors = errorsOf(samples, rows, result);
  return result;
}

}  // namespace pos::uwb
