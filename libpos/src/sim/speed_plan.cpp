#include "speed_plan.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::sim {
namespace {

/// The argument in [low, high] at which `f`, of different signs at both ends, is zero, by bisection.
double zeroBetween(double low, double high, const std::function<double(double)>& f) {
  const bool rising = f(high) > f(low);
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    ((f(middle) > 0.0) == rising ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// How long a step of given way takes at the mean of its two speeds (exact: all blends are symmetric).
double timeOf(double way, double from, double to, const std::string& key) {
  const double mean = 0.5 * (from + to);
  if (from * to < 0.0 || !(way / mean > 0.0) || !std::isfinite(way / mean)) {
    refuse("at these speeds the way is never covered", key,
           std::to_string(way) + " m from " + std::to_string(from) + " to " + std::to_string(to) + " m/s",
           "speeds in the direction of the way, not both zero", "give duration instead");
  }
  return way / mean;
}

double timeOf(const DriveStep& step, double way_so_far, double from, const std::string& key) {
  const double to = step.speed_to.value_or(from);
  requireFinite(to, key + ".speed_to");
  const int given =
      int{step.duration.has_value()} + int{step.length.has_value()} + int{step.until.has_value()};
  if (given != 1) {
    refuse("a step needs one of duration, length and until", key, std::to_string(given) + " of them", "one");
  }
  if (step.duration) {
    requirePositive(*step.duration, key + ".duration");
    return *step.duration;
  }
  if (step.until) return timeOf(*step.until - way_so_far, from, to, key + ".until");
  requirePositive(*step.length, key + ".length");
  return timeOf(from + to < 0.0 ? -*step.length : *step.length, from, to, key + ".length");
}

SpeedPiece pieceOf(const DriveStep& step, double way_so_far, double from, const std::string& key) {
  const SpeedPiece piece{.from = from,
                         .to = step.speed_to.value_or(from),
                         .length = timeOf(step, way_so_far, from, key),
                         .blend = step.speed_blend,
                         .ramp = step.speed_ramp};
  if (!(piece.ramp >= 0.0 && piece.ramp <= 0.5 * piece.length)) {
    refuse("the ramps are longer than the step", key + ".speed_ramp", std::to_string(piece.ramp),
           "0 to half of " + std::to_string(piece.length) + " s");
  }
  return piece;
}

}  // namespace

SpeedPlan::SpeedPlan(double start_speed, const std::vector<DriveStep>& steps, const std::string& key) {
  if (steps.empty()) refuse("the list is empty", key, "no entries", "at least one");
  requireFinite(start_speed, "start.speed");
  double speed = start_speed;
  double way = 0.0;
  std::vector<double> breaks;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const SpeedPiece piece = pieceOf(steps[i], way, speed, key + "[" + std::to_string(i) + "]");
    starts_.push_back(duration_);
    ways_.push_back(way);
    for (const double corner : piece.corners()) breaks.push_back(duration_ + corner);
    duration_ += piece.length;
    breaks.push_back(duration_);
    way += piece.way();
    speed = piece.to;
    pieces_.push_back(piece);
  }
  breaks_ = tidied(std::move(breaks), 0.0, duration_);
}

SpeedPiece::Value SpeedPlan::at(double t) const {
  const std::size_t i = pieceIndex(starts_, t);
  SpeedPiece::Value value = pieces_[i].at(t - starts_[i]);
  value.way += ways_[i];
  return value;
}

std::vector<double> SpeedPlan::turningTimes() const {
  std::vector<double> times;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    times.push_back(starts_[i]);
    const SpeedPiece& piece = pieces_[i];
    if (piece.from * piece.to >= 0.0) continue;
    times.push_back(starts_[i] +
                    zeroBetween(0.0, piece.length, [&piece](double x) { return piece.at(x).speed; }));
  }
  times.push_back(duration_);
  return times;
}

std::vector<double> SpeedPlan::timesAt(double way) const {
  const std::vector<double> turns = turningTimes();
  std::vector<double> times;
  for (std::size_t i = 0; i + 1 < turns.size(); ++i) {
    const auto excess = [this, way](double t) { return at(t).way - way; };
    if (excess(turns[i]) * excess(turns[i + 1]) >= 0.0) continue;
    times.push_back(zeroBetween(turns[i], turns[i + 1], excess));
  }
  return times;
}

SpeedPlan::Reach SpeedPlan::reach() const {
  Reach reach;
  for (const double t : turningTimes()) {
    const double way = at(t).way;
    reach = {std::min(reach.lowest, way), std::max(reach.highest, way)};
  }
  return reach;
}

}  // namespace pos::sim
