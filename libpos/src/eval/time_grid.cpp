#include "pos/eval/time_grid.hpp"

#include "pos/core/error.hpp"

namespace pos::eval {

std::optional<std::size_t> TimeGrid::indexOf(Stamp stamp) const {
  const Duration from_edge = stamp - origin + step / 2;
  if (from_edge < Duration{0}) return std::nullopt;
  const auto index = static_cast<std::size_t>(from_edge / step);
  return index < count ? std::optional(index) : std::nullopt;
}

std::vector<GridCell> gridCells(const ErrorSeries& errors, const TimeGrid& grid) {
  std::vector<GridCell> cells(grid.count);
  std::vector<Duration> distance(grid.count, Duration::max());
  for (const ErrorSample& sample : errors) {
    const auto index = grid.indexOf(sample.stamp);
    if (!index) continue;
    const Duration away = std::chrono::abs(sample.stamp - grid.at(*index));
    if (away >= distance[*index]) continue;
    distance[*index] = away;
    cells[*index] = {.squared_xy = sample.xy * sample.xy,
                     .nees_xy = sample.nees_xy.value_or(GridCell::kNothing),
                     .nees_pose = sample.nees_pose.value_or(GridCell::kNothing)};
  }
  return cells;
}

void NisGrid::add(Stamp stamp, const IngestReport& report) {
  if (report.verdict != Verdict::Applied || report.dof <= 0) return;
  const auto index = grid_.indexOf(stamp);
  if (!index) return;
  sums_[*index].nis += report.nis;
  sums_[*index].dof += report.dof;
}

std::vector<GridCell> NisGrid::into(std::vector<GridCell> cells) const {
  ensure(cells.size() == sums_.size(), "the NIS sums and the cells are of one grid");
  for (std::size_t k = 0; k < cells.size(); ++k) {
    cells[k].nis = sums_[k].nis;
    cells[k].nis_dof = sums_[k].dof;
  }
  return cells;
}

}  // namespace pos::eval
