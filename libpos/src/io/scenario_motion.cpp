/// Option tables of motions.
#include "scenario_options.hpp"

namespace pos::io {
namespace {

using namespace pos::sim;

const std::vector<NamedValue<Blend>> kBlends{{"linear", Blend::Linear},
                                             {"trapezoid", Blend::Trapezoid},
                                             {"cosine", Blend::Cosine},
                                             {"smooth", Blend::Smooth}};

/// Units of a change: over time or along a path.
struct ChangeUnits {
  std::string ramp;
  std::string amplitude;
  std::string period;
};
const ChangeUnits kInTime{"ramp_s", "wave_amplitude_deg_per_s", "wave_period_s"};
const ChangeUnits kAlongPath{"ramp_m", "wave_amplitude_deg_per_m", "wave_period_m"};

OptionTable<Change> changeOptions(const std::string& title, const std::string& text,
                                  const ChangeUnits& units) {
  return OptionTable<Change>(title, text)
      .number("by_deg", &Change::by, anything(), "From its begin to its end.")
      .choice("blend", &Change::blend, kBlends, "How the angle goes there.")
      .number(units.ramp, &Change::ramp, atLeast(0), "Ramp of the rate at either end, for trapezoid.")
      .number(units.amplitude, &Change::wave_amplitude, anything(), "Of a sine of the rate on top.")
      .number(units.period, &Change::wave_period, atLeast(0), "Of that sine.");
}

template <class T>
OptionTable<T>& withTurnAndClimb(OptionTable<T>& table, const ChangeUnits& units) {
  return table
      .table("turn", &T::turn, changeOptions("turn", "Change of heading.", units),
             "Change of heading, counter-clockwise.")
      .table("climb", &T::climb, changeOptions("climb", "Change of pitch.", units),
             "Change of pitch, nose up.");
}

/// The keys of a drive step that `drive` gives.
template <class T, class Member>
OptionTable<T>& withDrive(OptionTable<T>& table, Member drive) {
  return table
      .number(
          "duration_s", [drive](auto& s) -> auto& { return drive(s).duration; }, moreThan(0),
          "How long it takes.")
      .number(
          "length_m", [drive](auto& s) -> auto& { return drive(s).length; }, moreThan(0),
          "Way driven instead of a duration.")
      .number(
          "until_m", [drive](auto& s) -> auto& { return drive(s).until; }, anything(),
          "Way from the motion's start at which it ends, instead of a duration.")
      .number(
          "speed_to_m_per_s", [drive](auto& s) -> auto& { return drive(s).speed_to; }, between(-50, 50),
          "Speed at its end, negative backwards; absent: the speed stays.")
      .choice(
          "speed_blend", [drive](auto& s) -> auto& { return drive(s).speed_blend; }, kBlends,
          "How the speed goes there.")
      .number(
          "speed_ramp_s", [drive](auto& s) -> auto& { return drive(s).speed_ramp; }, atLeast(0),
          "Ramp of the acceleration at either end, for trapezoid.");
}

OptionTable<MotionStart> startOptions() {
  return OptionTable<MotionStart>("start", "Where and how the body starts.")
      .number(
          "x_m", [](auto& start) -> auto& { return start.p_map.x(); }, anything(), "East in the map.")
      .number(
          "y_m", [](auto& start) -> auto& { return start.p_map.y(); }, anything(), "North in the map.")
      .number(
          "z_m", [](auto& start) -> auto& { return start.p_map.z(); }, anything(), "Height in the map.")
      .number("heading_deg", &MotionStart::heading, between(-360, 360),
              "Counter-clockwise from the map's x axis.")
      .number("pitch_deg", &MotionStart::pitch, between(-90, 90), "Nose up.")
      .number("speed_m_per_s", &MotionStart::speed, between(-50, 50), "Forward positive.");
}

OptionTable<DriveStep> driveOptions() {
  OptionTable<DriveStep> table("drive", "One step of the drive along a path.");
  return withDrive(
      table, [](auto& step) -> auto& { return step; });
}

OptionTable<Segment> segmentOptions() {
  OptionTable<Segment> table("segments", "A step that turns and climbs in time.");
  withDrive(
      table, [](auto& segment) -> auto& { return segment.drive; });
  return withTurnAndClimb(table, kInTime);
}

OptionTable<PathElement> elementOptions() {
  OptionTable<PathElement> table("path", "A stretch of path.");
  table.number("length_m", &PathElement::length, moreThan(0), "Its length.")
      .number("radius_m", &PathElement::radius, moreThan(0),
              "Smallest radius of its turn (of its climb where nothing turns), instead of a length.");
  return withTurnAndClimb(table, kAlongPath);
}

OptionTable<RoutePoint> planOptions() {
  return OptionTable<RoutePoint>("plan", "A corner of the route seen from above.")
      .number("x_m", &RoutePoint::x, anything(), "East in the map.")
      .required()
      .number("y_m", &RoutePoint::y, anything(), "North in the map.")
      .required()
      .number("radius_m", &RoutePoint::radius, atLeast(0), "Of the bend that rounds the corner.");
}

OptionTable<GradePoint> profileOptions() {
  return OptionTable<GradePoint>("profile", "A point of the floor; the floor is straight between them.")
      .number("chainage_m", &GradePoint::chainage, atLeast(0), "Along the rounded route seen from above.")
      .required()
      .number("z_m", &GradePoint::z, anything(), "Height in the map.")
      .required()
      .number("radius_m", &GradePoint::radius, atLeast(0), "Of the arc that rounds the change of grade.");
}

OptionTable<SegmentMotionConfig> segmentMotionOptions() {
  using Config = SegmentMotionConfig;
  return OptionTable<Config>("segments", "One thing after another, in time.")
      .table("start", &Config::start, startOptions(), "Where and how the body starts.")
      .list("segments", &Config::segments, segmentOptions(), "What it does.")
      .required();
}

OptionTable<PathMotionConfig> pathMotionOptions() {
  using Config = PathMotionConfig;
  return OptionTable<Config>("path", "A path by its length, and how it is driven.")
      .table("start", &Config::start, startOptions(), "Where and how the path starts.")
      .list("path", &Config::path, elementOptions(), "Its stretches.")
      .required()
      .list("drive", &Config::drive, driveOptions(), "How it is driven.")
      .required();
}

OptionTable<RouteMotionConfig> routeMotionOptions() {
  using Config = RouteMotionConfig;
  return OptionTable<Config>("route", "A roadway by its corners and grades, and how it is driven.")
      .list(
          "plan", [](auto& m) -> auto& { return m.route.plan; }, planOptions(), "Corners seen from above.")
      .required()
      .list(
          "profile", [](auto& m) -> auto& { return m.route.profile; }, profileOptions(),
          "Heights of the floor; level at 0 where empty.")
      .number(
          "transition", [](auto& m) -> auto& { return m.route.transition; }, between(0, 0.5),
          "Share of a bend on which its curvature grows, and again falls (clothoids).")
      .list("drive", &Config::drive, driveOptions(), "How it is driven.")
      .required();
}

OptionTable<ShearerConfig> shearerOptions() {
  using Config = ShearerConfig;
  return OptionTable<Config>("shearer", "A shearer on its conveyor: passes, end operations, advance.")
      .integer("passes", &Config::passes, between(1, 1000), "Cutting cycles.")
      .number("pass_length_m", &Config::pass_length, moreThan(0), "Conveyor less shearer.")
      .number("pass_time_s", &Config::pass_time, moreThan(0), "Of a pass.")
      .number("dwell_time_s", &Config::dwell_time, atLeast(0), "Of an end operation.")
      .number("excursion_m", &Config::excursion, atLeast(0), "Away from the end and back during it.")
      .number("standstill_s", &Config::standstill, atLeast(0), "At each reversal.")
      .number("acceleration_m_per_s2", &Config::acceleration, moreThan(0), "Of every start and stop.")
      .number("s_bend_from_m", &Config::s_bend_from, atLeast(0),
              "From the end: where the conveyor leaves its old line.")
      .number("s_bend_to_m", &Config::s_bend_to, atLeast(0), "From the end: where it lies on the new one.")
      .number("advance_m", &Config::advance, atLeast(0), "Eastward, per cycle.")
      .numbers("creep_m", &Config::creep, between(-5, 5),
               "Northward, in each end operation; none where the list ends.")
      .number("bend_peak_m", &Config::bend_peak, between(0, 5), "Horizontal bend of the conveyor.")
      .number("floor_peak_m", &Config::floor_peak, between(0, 5), "Waves of the floor.")
      .number("inherited", &Config::inherited, between(0, 1), "Share of the last cycle's bend that stays.")
      .integer("seed", &Config::seed, atLeast(0), "Of the bends; the same in every run.")
      .number("support_lag_m", &Config::support_lag, atLeast(0),
              "Behind the shearer's centre, from which the supports have moved on.");
}

}  // namespace

OptionTable<MotionConfig> motionOptions() {
  constexpr auto self = [](auto& motion) -> auto& {
    return motion;
  };
  return OptionTable<MotionConfig>("motion", "What the vehicle does.")
      .selector("type", "How the motion is written down; decides which further keys there are.")
      .alternative("segments", self, segmentMotionOptions(), "One thing after another, in time.")
      .alternative("path", self, pathMotionOptions(), "A path by its length, and how it is driven.")
      .alternative("route", self, routeMotionOptions(),
                   "A roadway by its corners and grades, and how it is driven.")
      .alternative("shearer", self, shearerOptions(), "A shearer on its conveyor.");
}

}  // namespace pos::io
