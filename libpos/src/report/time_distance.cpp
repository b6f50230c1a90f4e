#include "pos/report/time_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "figure_parts.hpp"

namespace pos::report {
namespace {

using eval::IntervalFigures;
using eval::IntervalScene;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostPoints = 2000;
constexpr double kShort = 5.0;  // m, a shorter stay on a roadway is the edge of a junction

struct RoadPoint {
  double t = 0.0;
  map::RoadwayIndex roadway = 0;
  double chainage = 0.0;
};

/// A roadway on the axis; `start` is where it begins there.
struct AxisRoad {
  map::RoadwayIndex roadway = 0;
  double low = 0.0;  ///< m, chainage driven
  double high = 0.0;
  bool forward = true;
  double start = 0.0;
};

class RoadAxis {
 public:
  explicit RoadAxis(const std::vector<RoadPoint>& points) {
    for (std::size_t i = 0; i < points.size();) {
      std::size_t end = i;
      double low = points[i].chainage;
      double high = low;
      for (; end < points.size() && points[end].roadway == points[i].roadway; ++end) {
        low = std::min(low, points[end].chainage);
        high = std::max(high, points[end].chainage);
      }
      if (high - low >= kShort)
        add({points[i].roadway, low, high, points[end - 1].chainage >= points[i].chainage});
      i = end;
    }
    double start = roads_.size() == 1 ? roads_.front().low : 0.0;
    for (AxisRoad& road : roads_) {
      road.start = start;
      start += road.high - road.low;
    }
    if (roads_.size() == 1) roads_.front().forward = true;  // then the axis is the chainage itself
  }

  const std::vector<AxisRoad>& roads() const { return roads_; }
  double from() const { return roads_.front().start; }
  double to() const { return roads_.back().start + roads_.back().high - roads_.back().low; }
  /// NaN where the roadway is not on the axis.
  double at(map::RoadwayIndex roadway, double chainage) const {
    for (const AxisRoad& road : roads_) {
      if (road.roadway == roadway)
        return road.start + (road.forward ? chainage - road.low : road.high - chainage);
    }
    return kNothing;
  }

 private:
  void add(const AxisRoad& visit) {
    for (AxisRoad& road : roads_) {
      if (road.roadway != visit.roadway) continue;
      road.low = std::min(road.low, visit.low);
      road.high = std::max(road.high, visit.high);
      return;
    }
    roads_.push_back(visit);
  }
  std::vector<AxisRoad> roads_;
};

std::vector<RoadPoint> truthPoints(const eval::RunSummary& run) {
  std::vector<RoadPoint> points;
  for (const eval::PathPoint& p : run.truth_path) {
    const Pose3 pose{.translation = {p.x, p.y, 0.0}};
    if (const auto place = eval::trueInterval(*run.interval_scene, pose, false))
      points.push_back({p.t, place->roadway, place->chainage});
  }
  return points;
}

std::vector<RoadPoint> pointsOf(const IntervalFigures& figures, Stamp start) {
  std::vector<RoadPoint> points;
  for (const eval::IntervalSample& s : figures.record.samples) {
    if (s.matched) points.push_back({seconds(s.stamp - start), s.point.roadway, s.point.chainage});
  }
  return points;
}

DistanceLine lineOf(const std::vector<RoadPoint>& points, const RoadAxis& axis, const std::string& label,
                    const std::string& classes) {
  DistanceLine line{.label = label, .classes = classes};
  const std::size_t stride = std::max<std::size_t>(1, (points.size() + kMostPoints - 1) / kMostPoints);
  for (std::size_t i = 0; i < points.size(); i += stride) {
    line.t.push_back(points[i].t);
    line.distance.push_back(axis.at(points[i].roadway, points[i].chainage));
  }
  return line;
}

/// Stretches of an interval on the axis; on two lanes those of the lane that is driven.
std::vector<DistanceBand> bandsOf(const map::LockInterval& interval, const RoadAxis& axis) {
  std::vector<DistanceBand> bands;
  for (const AxisRoad& road : axis.roads()) {
    const map::Lane lane = road.forward ? map::Lane::Forward : map::Lane::Backward;
    for (const map::IntervalSpan& span : interval.spans) {
      if (span.roadway != road.roadway || (span.lane != map::Lane::Both && span.lane != lane)) continue;
      const auto [low, high] = std::minmax(span.from, span.to);
      const double from = std::max(low, road.low);
      const double to = std::min(high, road.high);
      if (to - from < 1.0) continue;
      const double one = axis.at(road.roadway, from);
      const double other = axis.at(road.roadway, to);
      bands.push_back({interval.label(), std::min(one, other), std::max(one, other)});
    }
  }
  return bands;
}

std::string axisLabel(const RoadAxis& axis, const map::TunnelMap& map) {
  if (axis.roads().size() == 1) return "chainage of " + map.roadways[axis.roads()[0].roadway].id + " (m)";
  std::string names;
  for (const AxisRoad& road : axis.roads())
    names += (names.empty() ? "" : ", ") + map.roadways[road.roadway].id;
  return "distance along " + shortened(names, 40) + " (m)";
}

/// Stays in intervals as the estimator told them, in its colour.
void addVisits(TimeDistance& diagram, const eval::RunSummary& run, std::size_t estimator,
               const RoadAxis& axis) {
  for (const eval::IntervalVisit& visit : run.estimators[estimator].intervals->record.visits) {
    const double begin = seconds(visit.entered - run.start);
    const double end = visit.left ? seconds(*visit.left - run.start) : diagram.t1;
    for (const DistanceBand& band : bandsOf(run.interval_scene->intervals[visit.interval], axis))
      diagram.bars.push_back({begin, end, band.from, band.to, estimator});
  }
  diagram.bar_names.push_back(
      {"intervals occupied, by " + shortened(run.estimators[estimator].name, kNameCharacters), estimator});
}

/// The one whose stays are drawn: the best of those with intervals.
std::optional<std::size_t> chosen(const eval::RunSummary& run) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < run.estimators.size(); ++i) {
    if (!run.estimators[i].intervals || run.estimators[i].intervals->record.samples.empty()) continue;
    if (!found || &run.estimators[i] == run.best()) found = i;
  }
  return found;
}

}  // namespace

std::optional<TimeDistance> timeDistance(const eval::RunSummary& run) {
  const auto shown = run.interval_scene ? chosen(run) : std::nullopt;
  if (!shown) return std::nullopt;
  const std::vector<RoadPoint> truth = truthPoints(run);
  const std::vector<RoadPoint> best = pointsOf(*run.estimators[*shown].intervals, run.start);
  const RoadAxis axis(truth.empty() ? best : truth);
  if (axis.roads().empty()) return std::nullopt;
  TimeDistance diagram{.name = "time_distance",
                       .title = "Time and distance along the road",
                       .distance_label = axisLabel(axis, run.interval_scene->network.map()),
                       .t1 = runLength(run),
                       .from = axis.from(),
                       .to = axis.to()};
  for (const map::LockInterval& interval : run.interval_scene->intervals) {
    const auto bands = bandsOf(interval, axis);
    diagram.bands.insert(diagram.bands.end(), bands.begin(), bands.end());
  }
  addVisits(diagram, run, *shown, axis);
  if (!truth.empty()) diagram.lines.push_back(lineOf(truth, axis, "truth", "truth"));
  for (std::size_t i = 0; i < run.estimators.size(); ++i) {
    if (!run.estimators[i].intervals) continue;
    diagram.lines.push_back(lineOf(pointsOf(*run.estimators[i].intervals, run.start), axis,
                                   run.estimators[i].name, strokeClass(i) + " curve"));
  }
  diagram.caption =
      "Bands are the lock intervals along the road, their names at the right; where two ways part, intervals "
      "overlap and stand side by side there. A bar is the time an interval counts as occupied; it should "
      "hold "
      "the line of the truth. A line that leaves the truth's is an error along the road.";
  return diagram;
}

std::optional<NamedFigure> intervalFigure(const eval::RunSummary& run) {
  const auto diagram = timeDistance(run);
  return diagram ? std::optional(timeDistanceFigure(*diagram)) : std::nullopt;
}

}  // namespace pos::report
