#pragma once
/// Axes with round tick values.

#include <string>
#include <vector>

#include "pos/report/svg.hpp"

namespace pos::report {

/// 1, 2 or 5 times a power of ten: the least that is no less than `least`, and the greatest that is no more
/// than `most` (both above zero).
double roundStep(double least);
double roundLength(double most);

/// Round values (1, 2 or 5 times a power of ten) inside [low, high], about `wanted` of them.
std::vector<double> niceTicks(double low, double high, int wanted);
/// Powers of ten inside [low, high].
std::vector<double> logTicks(double low, double high);

/// Value to pixel along one axis. A logarithmic scale draws everything below `low` at `low`.
struct Scale {
  double low = 0.0;
  double high = 1.0;
  double pixel_low = 0.0;
  double pixel_high = 1.0;
  bool logarithmic = false;

  double operator()(double value) const;
  /// About `wanted` round values. Logarithmic: powers of ten, with 2 and 5 between where there are few.
  std::vector<double> ticks(int wanted) const;
};

/// A frame with two scales.
struct Plot {
  Box box;
  Scale x;
  Scale y;

  Pixel operator()(double x_value, double y_value) const { return {x(x_value), y(y_value)}; }
};

struct AxisLabels {
  std::string x = {};  ///< with its unit: "time (s)"; empty leaves the tick labels out too
  std::string y = {};
};

/// A plot over `box`. Ranges of no width are widened so that something can be drawn.
Plot plotOver(const Box& box, double x_low, double x_high, double y_low, double y_high);
/// The same with a logarithmic y axis; 0 < y_low.
Plot logPlotOver(const Box& box, double x_low, double x_high, double y_low, double y_high);

/// Grid lines, tick labels, axis titles and the frame.
void drawAxes(Svg& svg, const Plot& plot, const AxisLabels& labels);

struct LegendEntry {
  std::string text;
  std::string classes;
  enum class Sign { Line, Square, Triangle, Band } sign = Sign::Line;
};

/// Entries from left to right, wrapped to `width`; returns the height used.
double drawLegend(Svg& svg, Pixel top_left, double width, const std::vector<LegendEntry>& entries);
/// Height the same legend will use.
double legendHeight(double width, const std::vector<LegendEntry>& entries);

}  // namespace pos::report
