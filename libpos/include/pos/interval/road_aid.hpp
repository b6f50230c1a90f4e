#pragma once
/// What the map can give back to an estimator: ordinary passage-fix measurements for `Estimator::ingest`,
/// which gates them like any other.

#include <optional>

#include "pos/core/measurement.hpp"
#include "pos/interval/road_tracker.hpp"

namespace pos::interval {

struct RoadAidRules {
  double rate = 1.0;              ///< Hz at most
  double min_move = 3.0;          ///< m between two fixes: standing still the road tells nothing new
  double heading_sigma = 0.0873;  ///< rad, 5 degrees
  double loose = 1000.0;          ///< m, sigma along the road: it says nothing about that
  double vertical_sigma = 1.0;    ///< m
  /// m over which the vehicle keeps its place in the lane; readings nearer to each other than this are
  /// not independent, and the variances are raised by the number of readings on that way.
  double correlation = 30.0;
  double gate_sigmas = 3.0;  ///< offsets beyond this many sigmas are not offered
  double straight = 0.005;   ///< 1/m, in tighter bends no fix is offered
};
RoadAidRules validated(RoadAidRules rules);

/// Sensor label of the fixes.
inline constexpr const char* kRoadSensor = "roadway";

class RoadAid {
 public:
  RoadAid(const map::Network& network, const RoadAidRules& rules);
  /// A fix across the road (in its lane, where there are two) and of the heading, when the road is decided
  /// and it is time for one.
  std::optional<Measurement> offered(const Estimate& estimate, const RoadTracker& road);

 private:
  map::Network network_;
  RoadAidRules rules_;
  std::optional<Stamp> last_;
  double last_travelled_ = 0.0;
};

}  // namespace pos::interval
