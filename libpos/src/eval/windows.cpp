#include "pos/eval/windows.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pos::eval {
namespace {

using Values = std::array<std::optional<double>, kWindowComponents.size()>;

Values valuesOf(const ErrorSample& sample) {
  Values values{std::abs(sample.x.value), std::abs(sample.y.value), {}, sample.xy, {}};
  if (sample.z) {
    values[2] = std::abs(sample.z->value);
    values[4] = std::hypot(sample.xy, sample.z->value);
  }
  return values;
}

WindowError more(WindowError sum, double value) {
  ++sum.count;
  sum.mean += value;
  sum.rmse += value * value;
  sum.max = std::max(sum.max, value);
  return sum;
}

WindowError figures(WindowError sum) {
  if (sum.count == 0) return sum;
  const auto n = static_cast<double>(sum.count);
  sum.mean /= n;
  sum.rmse = std::sqrt(sum.rmse / n);
  return sum;
}

}  // namespace

std::vector<WindowErrors> windowErrors(const ErrorSeries& errors, const std::vector<TimeWindow>& windows) {
  std::vector<WindowErrors> all;
  for (const TimeWindow& window : windows) {
    const bool known =
        std::any_of(all.begin(), all.end(), [&](const auto& each) { return each.name == window.name; });
    if (!known) all.push_back({.name = window.name});
  }
  for (WindowErrors& each : all) {
    const auto inside = [&](Stamp stamp) {
      return std::any_of(windows.begin(), windows.end(), [&](const TimeWindow& w) {
        return w.name == each.name && w.from <= stamp && stamp <= w.to;
      });
    };
    for (const ErrorSample& sample : errors) {
      if (!inside(sample.stamp)) continue;
      const Values values = valuesOf(sample);
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i]) each.errors[i] = more(each.errors[i], *values[i]);
      }
    }
    for (WindowError& error : each.errors) error = figures(error);
  }
  return all;
}

}  // namespace pos::eval
