#pragma once
/// One simulated vehicle and what goes wrong with its positions.

#include <optional>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/traffic/lock_traffic.hpp"

namespace pos::traffic {

struct Vehicle {
  interval::Enrol shape;
  double cruise = 5.0;  ///< m/s
  double sigma = 1.0;   ///< m, of its usual positions
  std::size_t depot = 0;
  double idle_until = 0.0;  ///< s, as all times here
  bool has_way = false;
  interval::Way way;
  std::size_t stop = 0;     ///< it may drive to
  double rear_limit = 0.0;  ///< m along the way, what it knows to hold behind
  bool on_road = false;
  bool asked = false;
  double d = 0.0;  ///< m along the way
  double speed = 0.0;
  double noise = 0.0;  ///< in sigmas, correlated in time
  double missing_until = 0.0;
  double jump_until = 0.0;
  double jump = 0.0;  ///< m
  double vague_until = 0.0;
  double vague_sigma = 0.0;  ///< m
  double alarm_until = 0.0;
  double doubted_since = -1.0;  ///< negative: it is not
  double announce_at = -1.0;    ///< after a restart; negative: nothing to announce
};

Vehicle newVehicle(int id, const std::vector<interval::Way>& ways, RandomStream& random);

/// What it hears of the engine's decisions about it.
void hear(Vehicle& v, const interval::LockRecord& record, double t);

/// One second of driving towards its stop without running into the others; returns the metres.
double drive(Vehicle& v, const std::vector<Vehicle>& all);

/// The position it reports, if it does. `before`: m along the way a second ago.
std::optional<interval::Report> position(Vehicle& v, double before, double t, const TrafficOptions& options,
                                         RandomStream& random);

/// Whether the bodies of two vehicles that move against each other touch the same section.
bool anyOpposing(const std::vector<Vehicle>& all);

}  // namespace pos::traffic
