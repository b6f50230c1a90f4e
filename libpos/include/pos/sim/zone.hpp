#pragma once
/// Stretches of a run, by time or by place, in which a radio or a satellite receiver works differently.

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pos/sim/timing.hpp"

namespace pos::sim {

/// Points of a closed outline in plan, m in the map; the last joins the first.
using Outline = std::vector<Eigen::Vector2d>;

/// Even-odd rule; a point on the outline may fall either way.
bool inside(const Outline& outline, const Eigen::Vector2d& p);

/// Where and when. Both given: both must hold. Neither: everywhere and always.
struct Zone {
  std::string name = {};
  std::optional<TimeSpan> time = {};
  Outline place = {};                             ///< empty: everywhere
  std::optional<Eigen::Vector2d> ramp_from = {};  ///< m; progress runs from here ...
  std::optional<Eigen::Vector2d> ramp_to = {};    ///< ... to here, instead of over the time span

  bool contains(double t, const Eigen::Vector2d& p) const;
  /// 0 at the zone's beginning, 1 at its end, limited to that: along the ramp where one is given, else over
  /// the time span, else 0.
  double progress(double t, const Eigen::Vector2d& p) const;
};

/// Throws ConfigError naming `key`: an empty time span, an outline of one or two points, half a ramp, a ramp
/// of no length.
Zone validated(Zone zone, const std::string& key);

/// A standard deviation that runs from `first` to `last` along a zone, evenly in its logarithm.
struct SigmaRamp {
  double first = 0.0;  ///< m
  double last = 0.0;   ///< m

  /// Both must be positive unless equal.
  double at(double progress) const;
};

}  // namespace pos::sim
