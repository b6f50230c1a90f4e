#include "pos/report/axes.hpp"

#include <algorithm>
#include <cmath>

#include "pos/report/text.hpp"

namespace pos::report {

namespace {

constexpr double kCharacter = 7.3;  ///< px, a generous mean width at 13 px
constexpr double kLegendRow = 21.0;
constexpr double kLegendSign = 30.0;

double entryWidth(const LegendEntry& entry) {
  return kLegendSign + kCharacter * static_cast<double>(characterCount(entry.text)) + 18.0;
}

/// Where every entry goes, relative to the legend's corner.
std::vector<Pixel> legendPlaces(double width, const std::vector<LegendEntry>& entries) {
  std::vector<Pixel> places;
  Pixel at;
  for (const LegendEntry& entry : entries) {
    if (at.x > 0.0 && at.x + entryWidth(entry) > width) at = {0.0, at.y + kLegendRow};
    places.push_back(at);
    at.x += entryWidth(entry);
  }
  return places;
}

Plot over(const Box& box, Scale x, Scale y) {
  const auto widen = [](Scale& scale) {
    if (scale.high > scale.low) return;
    const double pad = std::max(0.5, 0.1 * std::abs(scale.low));
    scale.high = scale.logarithmic ? 10.0 * scale.low : scale.low + pad;
    if (!scale.logarithmic) scale.low -= pad;
  };
  widen(x);
  widen(y);
  x.pixel_low = box.left;
  x.pixel_high = box.right();
  y.pixel_low = box.bottom();
  y.pixel_high = box.top;
  return {box, x, y};
}

}  // namespace

double roundStep(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (least <= factor * power * 1.0001) return factor * power;
  }
  return 10.0 * power;
}

double roundLength(double most) {
  const double power = std::pow(10.0, std::floor(std::log10(most)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= most) return factor * power;
  }
  return power;
}

std::vector<double> niceTicks(double low, double high, int wanted) {
  std::vector<double> ticks;
  if (!(high > low) || wanted < 1) return ticks;
  const double step = roundStep((high - low) / wanted);
  const double slack = 1e-9 * (high - low);
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; k += 1.0)
    ticks.push_back(k * step);
  return ticks;
}

std::vector<double> logTicks(double low, double high) {
  std::vector<double> ticks;
  if (!(low > 0.0) || !(high > low)) return ticks;
  for (double e = std::ceil(std::log10(low) - 1e-9); e <= std::log10(high) + 1e-9; e += 1.0) {
    ticks.push_back(std::pow(10.0, e));
  }
  return ticks;
}

double Scale::operator()(double value) const {
  if (!logarithmic) return pixel_low + (value - low) / (high - low) * (pixel_high - pixel_low);
  const double part = std::log(std::max(value, low) / low) / std::log(high / low);
  return pixel_low + part * (pixel_high - pixel_low);
}

std::vector<double> Scale::ticks(int wanted) const {
  if (!logarithmic) {
    std::vector<double> round = niceTicks(low, high, wanted);
    for (int more = wanted + 1; round.size() < 3 && more < 12; ++more) round = niceTicks(low, high, more);
    return round;
  }
  std::vector<double> decades = logTicks(low, high);
  if (decades.size() > 5 &&
      static_cast<int>(decades.size()) > wanted + 1) {  // every other, so that they can be read
    std::erase_if(decades, [](double tick) { return std::lround(std::log10(tick)) % 2 != 0; });
  }
  if (decades.size() >= 4 || 3 * static_cast<int>(decades.size()) > 2 * wanted) return decades;
  std::vector<double> all;
  const double first = std::pow(10.0, std::floor(std::log10(low)));
  for (double decade = first; decade <= high; decade *= 10.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor * decade >= low && factor * decade <= high) all.push_back(factor * decade);
    }
  }
  return all;
}

Plot plotOver(const Box& box, double x_low, double x_high, double y_low, double y_high) {
  return over(box, {.low = x_low, .high = x_high}, {.low = y_low, .high = y_high});
}

Plot logPlotOver(const Box& box, double x_low, double x_high, double y_low, double y_high) {
  return over(box, {.low = x_low, .high = x_high}, {.low = y_low, .high = y_high, .logarithmic = true});
}

void drawAxes(Svg& svg, const Plot& plot, const AxisLabels& labels) {
  const Box& box = plot.box;
  for (const double tick : plot.x.ticks(static_cast<int>(std::max(2.0, box.width / 90.0)))) {
    const double x = plot.x(tick);
    svg.line({x, box.top}, {x, box.bottom()}, "grid");
    if (!labels.x.empty()) svg.text({x, box.bottom() + 17.0}, tickText(tick), "middle small muted");
  }
  for (const double tick : plot.y.ticks(static_cast<int>(std::max(2.0, box.height / 40.0)))) {
    const double y = plot.y(tick);
    svg.line({box.left, y}, {box.right(), y}, "grid");
    svg.text({box.left - 7.0, y + 4.0}, tickText(tick), "end small muted");
  }
  svg.rect(box, "frame");
  if (!labels.x.empty()) svg.text({box.left + 0.5 * box.width, box.bottom() + 36.0}, labels.x, "middle");
  if (!labels.y.empty()) svg.uprightText({box.left - 52.0, box.top + 0.5 * box.height}, labels.y);
}

double legendHeight(double width, const std::vector<LegendEntry>& entries) {
  const std::vector<Pixel> places = legendPlaces(width, entries);
  return places.empty() ? 0.0 : places.back().y + kLegendRow;
}

double drawLegend(Svg& svg, Pixel top_left, double width, const std::vector<LegendEntry>& entries) {
  const std::vector<Pixel> places = legendPlaces(width, entries);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double x = top_left.x + places[i].x;
    const double y = top_left.y + places[i].y + 0.5 * kLegendRow;
    switch (entries[i].sign) {
      case LegendEntry::Sign::Line:
        svg.line({x, y}, {x + 22.0, y},
                 entries[i].classes == "truth" ? "truth" : entries[i].classes + " curve");
        break;
      case LegendEntry::Sign::Square:
        svg.rect({x + 6.0, y - 6.0, 12.0, 12.0}, entries[i].classes);
        break;
      case LegendEntry::Sign::Triangle:
        svg.polygon({{x + 12.0, y - 7.0}, {x + 18.5, y + 5.0}, {x + 5.5, y + 5.0}}, entries[i].classes);
        break;
      case LegendEntry::Sign::Band:
        svg.rect({x, y - 6.0, 22.0, 12.0}, entries[i].classes);
        break;
    }
    svg.text({x + kLegendSign - 2.0, y + 4.5}, entries[i].text);
  }
  return legendHeight(width, entries);
}

}  // namespace pos::report
