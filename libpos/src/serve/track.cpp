#include "pos/serve/track.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "pos/core/error.hpp"

namespace pos::serve {
namespace {

static_assert(std::endian::native == std::endian::little, "tracks are sent as they lie in memory");

float narrow(double value) {
  return static_cast<float>(value);
}

void setPose(TrackRow& row, const Pose3& pose) {
  row[Column::X] = narrow(pose.translation.x());
  row[Column::Y] = narrow(pose.translation.y());
  row[Column::Z] = narrow(pose.translation.z());
  row[Column::Yaw] = narrow(pose.yaw());
}

template <class Value>
void put(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

const std::array<std::string_view, kColumns>& columnNames() {
  static constexpr std::array<std::string_view, kColumns> kNames{
      "x_m",      "y_m",           "z_m",           "yaw_rad",    "sigma_x_m",     "sigma_y_m",
      "corr_x_y", "sigma_yaw_rad", "speed_m_per_s", "error_m",    "error_along_m", "error_across_m",
      "nis",      "gated",         "roadway",       "chainage_m", "interval"};
  return kNames;
}

std::optional<Column> columnOf(std::string_view name) {
  const auto found = std::find(columnNames().begin(), columnNames().end(), name);
  if (found == columnNames().end()) return std::nullopt;
  return static_cast<Column>(found - columnNames().begin());
}

TrackRow rowOf(const Estimate& estimate) {
  TrackRow row{.stamp = estimate.stamp};
  setPose(row, estimate.T_map_body);
  const Matrix<3, 3> P = estimate.planarCovariance();
  const double sigma_x = std::sqrt(std::max(0.0, P(0, 0)));
  const double sigma_y = std::sqrt(std::max(0.0, P(1, 1)));
  row[Column::SigmaX] = narrow(sigma_x);
  row[Column::SigmaY] = narrow(sigma_y);
  row[Column::CorrXY] = sigma_x > 0.0 && sigma_y > 0.0 ? narrow(P(0, 1) / (sigma_x * sigma_y)) : 0.0F;
  row[Column::SigmaYaw] = narrow(std::sqrt(std::max(0.0, P(2, 2))));
  if (estimate.twist) row[Column::Speed] = narrow(estimate.twist->rates.x());
  return row;
}

TrackRow rowOf(const TruthPose& truth) {
  TrackRow row{.stamp = truth.stamp};
  setPose(row, truth.T_map_body);
  return row;
}

void compare(TrackRow& row, const Pose3& T_map_truth, const std::optional<Eigen::Vector2d>& direction) {
  const Eigen::Vector2d error =
      Eigen::Vector2d(row[Column::X], row[Column::Y]) - T_map_truth.translation.head<2>();
  row[Column::Error] = narrow(error.norm());
  if (!direction) return;
  row[Column::ErrorAlong] = narrow(direction->dot(error));
  row[Column::ErrorAcross] = narrow(direction->x() * error.y() - direction->y() * error.x());
}

void place(TrackRow& row, const interval::IntervalBelief& belief) {
  const bool known =
      belief.state == interval::MatchState::Decided || belief.state == interval::MatchState::Branching;
  if (!known) return;
  row[Column::Roadway] = static_cast<float>(belief.point.roadway);
  row[Column::Chainage] = narrow(belief.point.chainage);
  if (!belief.intervals.empty())
    row[Column::Interval] = static_cast<float>(belief.intervals.front().interval);
}

void Track::append(const TrackRow& row) {
  ensure(stamps_.empty() || stamps_.back() <= row.stamp, "rows of a track come in time order");
  if (stamps_.size() >= kMostRows) {
    stamps_.erase(stamps_.begin(), stamps_.begin() + kMostRows / 2);
    for (auto& column : columns_) column.erase(column.begin(), column.begin() + kMostRows / 2);
  }
  stamps_.push_back(row.stamp);
  for (std::size_t i = 0; i < kColumns; ++i) columns_[i].push_back(row.values[i]);
}

void Track::clear() {
  stamps_.clear();
  for (auto& column : columns_) column.clear();
}

std::optional<Stamp> Track::first() const {
  return stamps_.empty() ? std::nullopt : std::optional(stamps_.front());
}
std::optional<Stamp> Track::last() const {
  return stamps_.empty() ? std::nullopt : std::optional(stamps_.back());
}

std::optional<TrackRow> Track::at(Stamp stamp) const {
  const auto after = std::upper_bound(stamps_.begin(), stamps_.end(), stamp);
  if (after == stamps_.begin()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - stamps_.begin()) - 1;
  TrackRow row{.stamp = stamps_[i]};
  for (std::size_t c = 0; c < kColumns; ++c) row.values[c] = columns_[c][i];
  return row;
}

/// The window with one row more on either side.
Track::Bounds Track::boundsOf(const TrackWindow& window) const {
  auto begin = window.from ? std::lower_bound(stamps_.begin(), stamps_.end(), *window.from) : stamps_.begin();
  auto end = window.to ? std::upper_bound(stamps_.begin(), stamps_.end(), *window.to) : stamps_.end();
  if (begin != stamps_.begin()) --begin;
  if (end != stamps_.end()) ++end;
  if (end < begin) end = begin;  // a window that ends before it begins
  return {static_cast<std::size_t>(begin - stamps_.begin()), static_cast<std::size_t>(end - stamps_.begin())};
}

void Track::addExtremes(std::size_t begin, std::size_t end, std::vector<std::size_t>& indices) const {
  std::array<std::size_t, 4> kept{};
  for (const Column column : {Column::X, Column::Y}) {
    const std::vector<float>& values = columns_[static_cast<std::size_t>(column)];
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto to = values.begin() + static_cast<std::ptrdiff_t>(end);
    const auto [low, high] = std::minmax_element(from, to);
    const std::size_t slot = column == Column::X ? 0 : 2;
    kept[slot] = static_cast<std::size_t>(low - values.begin());
    kept[slot + 1] = static_cast<std::size_t>(high - values.begin());
  }
  std::sort(kept.begin(), kept.end());
  indices.insert(indices.end(), kept.begin(), std::unique(kept.begin(), kept.end()));
}

std::vector<std::size_t> Track::chosen(const TrackWindow& window) const {
  const auto [begin, end] = boundsOf(window);
  const std::size_t count = end - begin;
  const std::size_t points = std::max<std::size_t>(window.points, 2);
  std::vector<std::size_t> indices;
  if (count <= points) {
    indices.resize(count);
    std::iota(indices.begin(), indices.end(), begin);
    return indices;
  }
  indices.push_back(begin);
  const std::size_t pieces = (points - 2) / 4;
  for (std::size_t k = 0; k < pieces; ++k)
    addExtremes(begin + 1 + (count - 2) * k / pieces, begin + 1 + (count - 2) * (k + 1) / pieces, indices);
  indices.push_back(end - 1);
  return indices;
}

std::string Track::packed(const TrackWindow& window) const {
  std::vector<Column> columns = window.columns;
  if (columns.empty()) {
    for (std::size_t i = 0; i < kColumns; ++i) columns.push_back(static_cast<Column>(i));
  }
  const std::vector<std::size_t> indices = chosen(window);
  const auto [begin, end] = boundsOf(window);
  std::string bytes = "POSTRK01";
  bytes.reserve(24 + indices.size() * (8 + 4 * columns.size()));
  put(bytes, static_cast<std::uint32_t>(indices.size()));
  put(bytes, static_cast<std::uint32_t>(end - begin));
  put(bytes, static_cast<std::uint32_t>(columns.size()));
  put(bytes, std::uint32_t{0});
  for (const std::size_t i : indices) put(bytes, secondsSinceOrigin(stamps_[i]));
  for (const Column column : columns) {
    const std::vector<float>& values = columns_[static_cast<std::size_t>(column)];
    for (const std::size_t i : indices) put(bytes, values[i]);
  }
  return bytes;
}

}  // namespace pos::serve
