#pragma once
/// Motions written as short lists: what the vehicle does one thing after another.
///
/// Two lists cover every vehicle of the papers. *Segments* say what happens in time (rest 5 s, speed up
/// within 1 s, turn by 0.4 rad within 2 s); *paths* say where the roadway goes by its length, and a list of
/// drive steps says how fast it is driven. The body's x axis follows the path; there is no roll and no crab
/// angle. Pitch is nose-up positive here (as the papers count it); Kinematics turns it into FLU rates.

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "pos/sim/motion.hpp"
#include "pos/sim/shearer.hpp"

namespace pos::sim {

/// How a quantity goes from its old value to its new one.
enum class Blend {
  Linear,     ///< at a constant rate, which jumps at both ends
  Trapezoid,  ///< the rate itself ramps up and down linearly over `ramp`
  Cosine,     ///< half a cosine wave: the rate is continuous
  Smooth      ///< 10u^3 - 15u^4 + 6u^5 (minimum jerk): rate and its derivative are continuous
};

/// A change of heading or pitch during a segment or along a path element.
struct Change {
  double by = 0.0;  ///< rad
  Blend blend = Blend::Linear;
  double ramp = 0.0;  ///< Trapezoid: s of a segment, m of a path element; at most half of it
  /// A rate amplitude * sin(2 pi u / period) on top, u from the start of the segment or element.
  double wave_amplitude = 0.0;  ///< rad/s, rad/m on a path
  double wave_period = 0.0;     ///< s, m on a path; needed where there is an amplitude

  bool operator==(const Change&) const = default;
};

/// Where and how the body starts.
struct MotionStart {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< m
  double heading = 0.0;                             ///< rad, from the map's x counter-clockwise
  double pitch = 0.0;                               ///< rad, nose-up
  double speed = 0.0;                               ///< m/s, forward positive

  bool operator==(const MotionStart&) const = default;
};

/// How long and how fast: one entry of a list in which each goes on where the last one ended. One of
/// duration, length and until says how long it takes. On a path one step may have none of the three: it goes
/// on for so long that the steps after it end at the path's end.
struct DriveStep {
  std::optional<double> duration = {};  ///< s
  std::optional<double> length = {};    ///< m along the path, positive also when driven backwards
  std::optional<double> until = {};  ///< m along the path from its start (signed distance travelled so far)
  std::optional<double> speed_to = {};  ///< m/s at its end, negative backwards; absent: the speed stays
  Blend speed_blend = Blend::Linear;
  double speed_ramp = 0.0;  ///< s, Trapezoid only

  bool operator==(const DriveStep&) const = default;
};

/// A drive step that turns and pitches in time. A rest is {.drive = {.duration = 5}} at speed 0.
struct Segment {
  DriveStep drive = {};
  Change turn = {};   ///< heading, counter-clockwise positive
  Change climb = {};  ///< pitch, nose-up positive

  bool operator==(const Segment&) const = default;
};

struct SegmentMotionConfig {
  MotionStart start = {};
  std::vector<Segment> segments = {};

  bool operator==(const SegmentMotionConfig&) const = default;
};

/// A stretch of path. Its length is given, or follows from the turn and the radius.
struct PathElement {
  std::optional<double> length = {};  ///< m
  /// m, smallest radius of the turn (of the climb where nothing turns), instead of a length
  std::optional<double> radius = {};
  Change turn = {};   ///< of heading, over the element's length
  Change climb = {};  ///< of pitch

  bool operator==(const PathElement&) const = default;
};

/// A corner of a route seen from above. The first and the last are its ends.
struct RoutePoint {
  double x = 0.0;       ///< m
  double y = 0.0;       ///< m
  double radius = 0.0;  ///< m, of the bend that rounds the corner; not used at the ends

  bool operator==(const RoutePoint&) const = default;
};

/// A point of a route's floor profile. The floor is straight between them.
struct GradePoint {
  double chainage = 0.0;  ///< m along the rounded route seen from above
  double z = 0.0;         ///< m
  double radius = 0.0;    ///< m, of the vertical arc that rounds the change of grade; not used at the ends

  bool operator==(const GradePoint&) const = default;
};

/// A roadway as roads are designed: a plan of straights and bends and a profile of grades and vertical arcs.
/// A vertical arc may not lie in a bend.
struct Route {
  std::vector<RoutePoint> plan = {};     ///< two or more
  std::vector<GradePoint> profile = {};  ///< ascending, within the route; empty: level at z = 0
  /// Share of a bend's length on which the curvature grows and again falls linearly (clothoids): 0 arcs ..
  /// 0.5
  double transition = 0.0;

  bool operator==(const Route&) const = default;
};

/// A route as path elements, how long it is, and where it starts (speed 0). Throws ConfigError where bends overlap or a
/// change of grade lies in a bend.
struct RoutedPath {
  MotionStart start = {};
  std::vector<PathElement> path = {};
  double length = 0.0;  ///< m along the path, grades counted
};
RoutedPath routed(const Route& route);

struct PathMotionConfig {
  MotionStart start = {};
  std::vector<PathElement> path = {};
  /// May go back and forth, but not leave the path.
  std::vector<DriveStep> drive = {};

  bool operator==(const PathMotionConfig&) const = default;
};

struct RouteMotionConfig {
  Route route = {};
  std::vector<DriveStep> drive = {};

  bool operator==(const RouteMotionConfig&) const = default;
};

/// What a scenario can be told to do.
using MotionConfig = std::variant<SegmentMotionConfig, PathMotionConfig, RouteMotionConfig, ShearerConfig>;

/// The motion itself; throws ConfigError with the key of the first entry that cannot be driven. A query costs
/// O(log n) in the number of entries, plus one ten-point quadrature where no closed form exists.
std::unique_ptr<Motion> makeMotion(const MotionConfig& config);
std::unique_ptr<Motion> makeSegmentMotion(const SegmentMotionConfig& config);
std::unique_ptr<Motion> makePathMotion(const PathMotionConfig& config);
std::unique_ptr<Motion> makeRouteMotion(const RouteMotionConfig& config);

}  // namespace pos::sim
