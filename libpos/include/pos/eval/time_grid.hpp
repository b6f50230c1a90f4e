#pragma once
/// The common clock of a campaign: all runs are looked at in the same moments, so that errors can be averaged
/// over runs moment by moment.

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "pos/core/verdict.hpp"
#include "pos/eval/errors.hpp"

namespace pos::eval {

/// Moments origin + k * step, k = 0 .. count - 1.
struct TimeGrid {
  Stamp origin;
  Duration step{1};  ///< > 0
  std::size_t count = 0;

  /// The moment nearest to `stamp`; nothing before the first or after the last by more than half a step.
  std::optional<std::size_t> indexOf(Stamp stamp) const;
  Stamp at(std::size_t index) const { return origin + static_cast<Duration::rep>(index) * step; }
};

/// What one run has to say of one moment. NaN: nothing.
struct GridCell {
  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  double squared_xy = kNothing;  ///< m^2, squared horizontal error
  double nees_xy = kNothing;     ///< 2 dof
  double nees_pose = kNothing;   ///< 3 dof
  double nis = 0.0;              ///< sum over the applied readings of the moment's step
  double nis_dof = 0.0;          ///< their degrees of freedom
};

/// One run on the grid. A moment takes the sample nearest to it, of equally near ones the earlier; samples
/// are not averaged, so that a cell stays chi-square distributed and errors keep their peaks.
std::vector<GridCell> gridCells(const ErrorSeries& errors, const TimeGrid& grid);

/// Sums the NIS of applied readings moment by moment.
class NisGrid {
 public:
  explicit NisGrid(const TimeGrid& grid) : grid_(grid), sums_(grid.count) {}

  void add(Stamp stamp, const IngestReport& report);
  /// Writes the sums into the cells of the same grid.
  std::vector<GridCell> into(std::vector<GridCell> cells) const;

 private:
  struct Sum {
    double nis = 0.0;
    double dof = 0.0;
  };
  TimeGrid grid_;
  std::vector<Sum> sums_;
};

}  // namespace pos::eval
