#pragma once
/// The time-distance diagram: time to the right, distance along a road upwards, lock intervals as bands,
/// locks as bars, vehicles as lines.

#include <string>
#include <vector>

#include "pos/eval/run_summary.hpp"
#include "pos/report/figures.hpp"

namespace pos::report {

/// A lock interval, or any other stretch of the road with a name.
struct DistanceBand {
  std::string label = {};
  double from = 0.0;  ///< m, from < to
  double to = 0.0;
};

/// A stretch of road that is held for a time.
struct LockBar {
  double begin = 0.0;  ///< s
  double end = 0.0;
  double from = 0.0;  ///< m, from < to
  double to = 0.0;
  std::size_t colour = 0;  ///< series colour
};

/// Where one vehicle is; a NaN distance breaks the line.
struct DistanceLine {
  std::string label = {};    ///< in the legend where `legend` is set, otherwise beside the line
  std::string classes = {};  ///< stroke
  bool legend = true;
  std::vector<double> t = {};         ///< s
  std::vector<double> distance = {};  ///< m
};

struct TimeDistance {
  std::string name = {};  ///< file name without ending
  std::string title = {};
  std::string caption = {};
  std::string time_label = "time since the start (s)";
  std::string distance_label = {};  ///< with its unit
  double t0 = 0.0;                  ///< s
  double t1 = 1.0;
  double from = 0.0;  ///< m
  double to = 1.0;
  std::vector<DistanceBand> bands = {};
  std::vector<LockBar> bars = {};
  std::vector<DistanceLine> lines = {};
  struct BarName {
    std::string text = {};
    std::size_t colour = 0;
  };
  std::vector<BarName> bar_names = {};  ///< legend of the bars
};

NamedFigure timeDistanceFigure(const TimeDistance& diagram);

/// The diagram of a run: the roadways in the order of the first visit, by truth where there is one. Nothing
/// where no intervals were evaluated.
std::optional<TimeDistance> timeDistance(const eval::RunSummary& run);

}  // namespace pos::report
