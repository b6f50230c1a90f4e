#pragma once
/// Checks and parts that segments and paths have in common.

#include <algorithm>
#include <string>

#include "curve.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/config_checks.hpp"

namespace pos::sim {

inline void requireStart(const MotionStart& start) {
  if (!start.p_map.allFinite()) refuse("the start is no place", "start", "", "x, y, z in metres");
  requireFinite(start.heading, "start.heading");
  requireFinite(start.pitch, "start.pitch");
  requireFinite(start.speed, "start.speed");
}

/// The formula of a change over `length` (s or m); throws ConfigError.
inline AnglePiece anglePiece(double start, double length, const Change& change, const std::string& key) {
  requireFinite(change.by, key + ".by");
  if (!(change.ramp >= 0.0 && change.ramp <= 0.5 * length)) {
    refuse("the ramps are longer than the piece", key + ".ramp", std::to_string(change.ramp),
           "0 to half of " + std::to_string(length));
  }
  requireFinite(change.wave_amplitude, key + ".wave_amplitude");
  if (change.wave_amplitude != 0.0) requirePositive(change.wave_period, key + ".wave_period");
  return {.start = start, .length = length, .change = change};
}

/// A body without roll has no heading when it points straight up or down.
inline void requirePitch(const AnglePiece& pitch, const std::string& key) {
  constexpr double kSteepest = radians(80.0);
  if (std::abs(pitch.start) > kSteepest || std::abs(pitch.end()) > kSteepest) {
    refuse("the body would stand upright", key, std::to_string(degrees(pitch.end())) + " deg",
           "a pitch within 80 deg");
  }
}

inline Kinematics stoppedAt(const Eigen::Vector3d& p_map, double heading, double pitch) {
  Kinematics body = attitudeOf({.value = heading}, {.value = pitch});
  body.p_map = p_map;
  return body;
}

}  // namespace pos::sim
