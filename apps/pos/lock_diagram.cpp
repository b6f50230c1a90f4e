#include <algorithm>
#include <cmath>
#include <limits>

#include "lock_yard.hpp"

namespace pos::app {
namespace {

using interval::LockRecord;
using interval::Way;
using interval::WaySection;

constexpr std::size_t kSameWay = 0;  // colours
constexpr std::size_t kOtherWay = 1;

const Way& longest(const std::vector<Way>& ways) {
  return *std::max_element(ways.begin(), ways.end(),
                           [](const Way& a, const Way& b) { return a.stops.back().at < b.stops.back().at; });
}

/// The way that is drawn, and what it is called.
struct Axis {
  Way way;
  std::string name;
};
Axis axisOf(const LockYard& yard, const io::LocksConfig& config) {
  const auto& routes = yard.network().map().routes;
  const bool any = config.diagram.route || (!routes.empty() && config.ways != io::LocksConfig::Ways::Ends);
  if (any) {
    const std::string id = config.diagram.route.value_or(routes.empty() ? "" : routes.front().id);
    return {yard.locks().way(yard.route(id)), "route " + id};
  }
  const Way& way = longest(yard.ways());
  const auto& stops = yard.locks().site()->stops;
  return {way, "the way from " + stops[way.stops.front().stop].id + " to " + stops[way.stops.back().stop].id};
}

}  // namespace

LockDiagram::LockDiagram(const LockYard& yard, const io::LocksConfig& config)
    : yard_(yard), site_(yard.locks().site()) {
  const Axis axis = axisOf(yard, config);
  way_ = axis.way;
  diagram_.name = "time_distance";
  diagram_.title = "Time and distance along " + axis.name;
  diagram_.distance_label = "distance along " + axis.name + " (m)";
  diagram_.t0 = config.diagram.from;
  diagram_.t1 = config.diagram.from + config.diagram.length;
  diagram_.to = way_.stops.back().at;
  diagram_.bands = bands();
  diagram_.bar_names = {{"locked in the direction of the axis", kSameWay},
                        {"locked for another movement", kOtherWay}};
  diagram_.caption =
      "Every line is a vehicle on the road, its number beside it; vehicles in passing chambers leave the "
      "diagram. A bar is a section that is locked: no line may be outside a bar of its own, and blue and "
      "orange bars never lie on each other. Bands are the lock intervals, their names at the right.";
}

std::vector<report::DistanceBand> LockDiagram::bands() const {
  std::vector<report::DistanceBand> bands;
  for (std::size_t i = 0; i < yard_.intervals().size(); ++i) {
    bool open = false;
    for (const WaySection& s : way_.sections) {
      const auto& of = site_->sections[s.section].intervals;
      const bool inside = std::find(of.begin(), of.end(), i) != of.end();
      if (inside && open) bands.back().to = s.to;
      if (inside && !open) bands.push_back({yard_.intervals()[i].label(), s.from, s.to});
      open = inside;
    }
  }
  return bands;
}

void LockDiagram::end(std::vector<Held>::iterator held, double t) {
  const WaySection& s = way_.sections[held->index];
  const bool seen = t > diagram_.t0 && held->since < diagram_.t1;
  if (seen) {
    diagram_.bars.push_back(
        {held->since, t, s.from, s.to, held->movement == s.movement ? kSameWay : kOtherWay});
  }
  held_.erase(held);
}

void LockDiagram::take(const interval::LockEvent& event, const std::vector<LockRecord>& records) {
  t_ = secondsSinceOrigin(event.stamp);
  if (t_ > diagram_.t1 + 1.0 && held_.empty()) return;
  for (const LockRecord& r : records) {
    if (r.kind == LockRecord::Kind::Restarted) {
      while (!held_.empty()) end(held_.end() - 1, t_);
    }
    for (std::size_t i = 0; i < way_.sections.size(); ++i) {
      if (way_.sections[i].section != r.section) continue;
      if (r.kind == LockRecord::Kind::Locked && t_ < diagram_.t1)
        held_.push_back({i, r.vehicle, r.movement, t_});
      if (r.kind != LockRecord::Kind::Released) continue;
      const auto mine = std::find_if(held_.begin(), held_.end(), [&](const Held& h) {
        return h.index == i && h.vehicle == r.vehicle && h.movement == r.movement;
      });
      if (mine != held_.end()) end(mine, t_);
    }
  }
}

/// NaN where the vehicle is not on the way that is drawn.
double LockDiagram::onAxis(const traffic::TruePlace& place) const {
  for (const WaySection& theirs : place.way->sections) {
    if (place.distance < theirs.from || place.distance > theirs.to) continue;
    for (const WaySection& mine : way_.sections) {
      if (mine.section != theirs.section) continue;
      const double into = place.distance - theirs.from;
      if (mine.movement == theirs.movement) return mine.from + into;
      if (mine.movement == -theirs.movement) return mine.to - into;
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void LockDiagram::take(double t, const std::vector<traffic::TruePlace>& places) {
  if (t < diagram_.t0 || t > diagram_.t1) return;
  for (const traffic::TruePlace& place : places) {
    const auto label = std::to_string(place.vehicle);
    auto line = std::find_if(diagram_.lines.begin(), diagram_.lines.end(),
                             [&](const report::DistanceLine& l) { return l.label == label; });
    if (line == diagram_.lines.end()) {
      diagram_.lines.push_back({.label = label, .classes = "vehicle", .legend = false});
      line = diagram_.lines.end() - 1;
    }
    const double distance = onAxis(place);
    if (!line->t.empty() && (t - line->t.back() > 1.5 || std::abs(distance - line->distance.back()) > 60.0)) {
      line->t.push_back(t);  // it was off the road in between
      line->distance.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    line->t.push_back(t);
    line->distance.push_back(distance);
  }
}

report::TimeDistance LockDiagram::finish() {
  while (!held_.empty()) end(held_.end() - 1, t_);
  diagram_.t1 = std::min(diagram_.t1, std::max(t_, diagram_.t0 + 10.0));
  return std::move(diagram_);
}

}  // namespace pos::app
