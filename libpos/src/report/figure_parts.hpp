#pragma once
/// What the figures share: size, names of estimators, and one function per drawing. Internal to report.

#include <optional>
#include <string>
#include <vector>

#include "pos/eval/run_summary.hpp"
#include "pos/report/axes.hpp"
#include "pos/report/figures.hpp"
#include "pos/report/svg.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

inline constexpr double kFigureWidth = 920.0;
inline constexpr double kLeft = 74.0;
inline constexpr double kRight = 24.0;
inline constexpr double kTitleHeight = 34.0;  ///< title line above everything else
inline constexpr double kBelow = 46.0;        ///< tick labels and title of the x axis
inline constexpr double kPlotWidth = kFigureWidth - kLeft - kRight;

/// Estimator names longer than this are shortened in legends and row labels.
inline constexpr std::size_t kNameCharacters = 26;

/// One entry per estimator that passes `shown`, in its colour.
template <class Shown>
std::vector<LegendEntry> estimatorLegend(const eval::RunSummary& run, Shown shown) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < run.estimators.size(); ++i) {
    if (shown(run.estimators[i]))
      entries.push_back({shortened(run.estimators[i].name, kNameCharacters), strokeClass(i)});
  }
  return entries;
}

/// The time axis: zero to the end of the run.
double runLength(const eval::RunSummary& run);
/// True when the largest value is so far above the smallest that only a logarithmic axis shows both.
bool wantsLogarithm(double smallest, double largest);

// Each gives nothing where the run has no data for it.
std::optional<NamedFigure> planFigure(const eval::RunSummary& run);
std::optional<NamedFigure> errorFigure(const eval::RunSummary& run);
std::optional<NamedFigure> componentFigure(const eval::RunSummary& run, std::size_t estimator);
std::optional<NamedFigure> cdfFigure(const eval::RunSummary& run);
std::optional<NamedFigure> neesFigure(const eval::RunSummary& run);
std::optional<NamedFigure> modesFigure(const eval::RunSummary& run);
std::optional<NamedFigure> intervalFigure(const eval::RunSummary& run);
std::optional<NamedFigure> sensorVerdictFigure(const eval::RunSummary& run);
std::optional<NamedFigure> anchorVerdictFigure(const eval::RunSummary& run);
std::optional<NamedFigure> residualFigure(const eval::RunSummary& run);
std::optional<NamedFigure> computeFigure(const eval::RunSummary& run);

}  // namespace pos::report
