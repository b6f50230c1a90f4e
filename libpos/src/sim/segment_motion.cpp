#include "curve.hpp"
#include "plan_parts.hpp"
#include "pos/core/config_checks.hpp"
#include "speed_plan.hpp"

namespace pos::sim {
namespace {

class SegmentMotion final : public Motion {
 public:
  SegmentMotion(const SpeedPlan& speeds, Curve curve) : speeds_(speeds), curve_(std::move(curve)) {
    std::vector<double> breaks = curve_.breaks();
    breaks.insert(breaks.end(), speeds_.breaks().begin(), speeds_.breaks().end());
    breaks_ = tidied(std::move(breaks), 0.0, speeds_.duration());
  }

  Kinematics at(double t) const override {
    const CurvePoint point = curve_.at(std::clamp(t, 0.0, duration()));
    if (t < 0.0 || t > duration()) return stoppedAt(point.p_map, point.heading.value, point.pitch.value);
    return kinematicsOf({point.p_map, point.speed, point.acceleration, point.heading, point.pitch});
  }
  double duration() const override { return speeds_.duration(); }
  double travelled(double t) const override { return speeds_.at(std::clamp(t, 0.0, duration())).way; }
  const std::vector<double>& breaks() const override { return breaks_; }

 private:
  SpeedPlan speeds_;
  Curve curve_;
  std::vector<double> breaks_;
};

}  // namespace

std::unique_ptr<Motion> makeSegmentMotion(const SegmentMotionConfig& config) {
  requireStart(config.start);
  std::vector<DriveStep> steps;
  for (const Segment& segment : config.segments) steps.push_back(segment.drive);
  const SpeedPlan speeds(config.start.speed, steps, "segments");
  std::vector<CurvePiece> pieces;
  double heading = config.start.heading;
  double pitch = config.start.pitch;
  for (std::size_t i = 0; i < config.segments.size(); ++i) {
    const std::string key = "segments[" + std::to_string(i) + "]";
    CurvePiece piece{.length = speeds.piece(i).length, .speed = speeds.piece(i)};
    piece.heading = anglePiece(heading, piece.length, config.segments[i].turn, key + ".turn");
    piece.pitch = anglePiece(pitch, piece.length, config.segments[i].climb, key + ".climb");
    requirePitch(piece.pitch, key + ".climb");
    heading = piece.heading.end();
    pitch = piece.pitch.end();
    pieces.push_back(piece);
  }
  return std::make_unique<SegmentMotion>(speeds, Curve(config.start.p_map, std::move(pieces)));
}

}  // namespace pos::sim
