#include <cmath>
#include <optional>

#include "blend.hpp"
#include "curve.hpp"
#include "plan_parts.hpp"
#include "pos/core/config_checks.hpp"
#include "speed_plan.hpp"

namespace pos::sim {
namespace {

class PathMotion final : public Motion {
 public:
  PathMotion(const SpeedPlan& speeds, Curve path) : speeds_(speeds), path_(std::move(path)) {
    std::vector<double> breaks = speeds_.breaks();
    for (const double way : path_.breaks()) {
      const std::vector<double> times = speeds_.timesAt(way);
      breaks.insert(breaks.end(), times.begin(), times.end());
    }
    breaks_ = tidied(std::move(breaks), 0.0, speeds_.duration());
  }

  Kinematics at(double t) const override {
    const SpeedPiece::Value drive = speeds_.at(std::clamp(t, 0.0, duration()));
    const CurvePoint point = path_.at(drive.way);
    if (t < 0.0 || t > duration()) return stoppedAt(point.p_map, point.heading.value, point.pitch.value);
    return kinematicsOf({point.p_map, drive.speed, drive.acceleration, overTime(point.heading, drive),
                         overTime(point.pitch, drive)});
  }
  double duration() const override { return speeds_.duration(); }
  double travelled(double t) const override { return speeds_.at(std::clamp(t, 0.0, duration())).way; }
  const std::vector<double>& breaks() const override { return breaks_; }

 private:
  /// Derivatives by path length become derivatives by time.
  static Jet overTime(const Jet& angle, const SpeedPiece::Value& drive) {
    return {angle.value, angle.rate * drive.speed,
            angle.bend * drive.speed * drive.speed + angle.rate * drive.acceleration};
  }

  SpeedPlan speeds_;
  Curve path_;
  std::vector<double> breaks_;
};

/// The length on which a change keeps to a smallest radius: 1 / radius = |by| * peak rate / length.
double lengthFor(const Change& change, double radius) {
  if (change.blend == Blend::Trapezoid) return radius * std::abs(change.by) + change.ramp;
  return radius * std::abs(change.by) * peakRate(change.blend, 0.0);
}

double lengthOf(const PathElement& element, const std::string& key) {
  if (element.length.has_value() == element.radius.has_value()) {
    refuse("an element needs a length or a radius", key, element.length ? "both" : "neither", "one of them");
  }
  if (element.length) {
    requirePositive(*element.length, key + ".length");
    return *element.length;
  }
  requirePositive(*element.radius, key + ".radius");
  const Change& change = element.turn.by != 0.0 ? element.turn : element.climb;
  const double length = lengthFor(change, *element.radius);
  if (!(length > 0.0)) {
    refuse("a radius, but nothing turns", key + ".radius", std::to_string(*element.radius),
           "a turn or a climb");
  }
  return length;
}

Curve curveOf(const MotionStart& start, const std::vector<PathElement>& path) {
  if (path.empty()) refuse("the path is empty", "path", "no elements", "at least one");
  std::vector<CurvePiece> pieces;
  double heading = start.heading;
  double pitch = start.pitch;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string key = "path[" + std::to_string(i) + "]";
    const double length = lengthOf(path[i], key);
    CurvePiece piece{.length = length, .speed = {.from = 1.0, .to = 1.0, .length = length}};
    piece.heading = anglePiece(heading, length, path[i].turn, key + ".turn");
    piece.pitch = anglePiece(pitch, length, path[i].climb, key + ".climb");
    requirePitch(piece.pitch, key + ".climb");
    heading = piece.heading.end();
    pitch = piece.pitch.end();
    pieces.push_back(piece);
  }
  return {start.p_map, std::move(pieces)};
}

bool isOpen(const DriveStep& step) {
  return !step.duration && !step.length && !step.until;
}

/// Signed way of the steps after `first`, none of which may depend on where it begins.
double wayAfter(const std::vector<DriveStep>& drive, std::size_t first, double speed) {
  double way = 0.0;
  for (std::size_t i = first; i < drive.size(); ++i) {
    const std::string key = "drive[" + std::to_string(i) + "]";
    if (isOpen(drive[i]) || drive[i].until) {
      refuse("a step after the one that fills the path has no length of its own", key, "neither or until",
             "duration or length");
    }
    const double mean = 0.5 * (speed + drive[i].speed_to.value_or(speed));
    way += drive[i].duration ? mean * *drive[i].duration : std::copysign(*drive[i].length, mean);
    speed = drive[i].speed_to.value_or(speed);
  }
  return way;
}

/// The same steps with the open one told where to end.
std::vector<DriveStep> filled(std::vector<DriveStep> drive, double start_speed, double length) {
  double speed = start_speed;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    speed = drive[i].speed_to.value_or(speed);
    if (!isOpen(drive[i])) continue;
    drive[i].until = length - wayAfter(drive, i + 1, speed);
    break;
  }
  return drive;
}

}  // namespace

std::unique_ptr<Motion> makePathMotion(const PathMotionConfig& config) {
  requireStart(config.start);
  Curve path = curveOf(config.start, config.path);
  const SpeedPlan speeds(config.start.speed, filled(config.drive, config.start.speed, path.length()),
                         "drive");
  constexpr double kRounding = 1e-6;
  const SpeedPlan::Reach reach = speeds.reach();
  if (reach.lowest < -kRounding || reach.highest > path.length() + kRounding) {
    refuse("the drive leaves the path", "drive",
           std::to_string(reach.lowest) + " to " + std::to_string(reach.highest) + " m",
           "0 to " + std::to_string(path.length()) + " m");
  }
  return std::make_unique<PathMotion>(speeds, std::move(path));
}

}  // namespace pos::sim
