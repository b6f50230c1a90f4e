#pragma once
/// Legs of the hydraulic supports of a longwall, and how a laser scanner sees them (spec B, B5 and B10).

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/pose3.hpp"

namespace pos::sim {

/// Reference point of a support's leg in the map (m) at `t` seconds: on the leg's axis, at the height of the
/// scan plane. Supports move once a cycle, when and where the scenario says. Must be cheap and pure.
using LegPlacer = std::function<Eigen::Vector3d(int support, double t)>;

/// A row of supports, numbered along the face. Support i stands near station `station_first + i * spacing`.
struct SupportRow {
  int count = 254;
  double spacing = 1.5;                                  ///< m
  double station_first = -15.0;                          ///< m along `along_map` from `origin_map`
  Eigen::Vector2d origin_map = Eigen::Vector2d::Zero();  ///< m, station 0
  Eigen::Vector2d along_map = Eigen::Vector2d::UnitY();  ///< unit vector, direction of rising station
  double radius = 0.15;                                  ///< m, of a leg
  double tilt = 0.17453292519943295;                     ///< rad, leg axis off the vertical
  double tilt_heading = 0.0;   ///< rad in the map, the way the upper end leans (0 = +x, towards the face)
  double station_slack = 1.0;  ///< m, how far `leg` may stray from the lattice along the face
};

/// Throws ConfigError naming `key` and the first field that cannot be.
SupportRow validated(SupportRow row, const std::string& key);

/// The row of spec B10 before any bend or creep: all supports stand `lateral` m to the left of the line they
/// started from (x = track - lateral), and everything advances by `advance` m along +x at each of
/// `advance_times` (s, ascending), at once.
LegPlacer straightRow(const SupportRow& row, double lateral, double advance,
                      std::vector<double> advance_times);

/// Numbers of the supports that can lie within `reach` m of station `station`: [first, last), clipped to the
/// row.
struct SupportSpan {
  int first = 0;
  int last = 0;
};
SupportSpan supportsNear(const SupportRow& row, double station, double reach);

/// A tilted, endless cylinder in the scanner's frame (m).
struct LegCylinder {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the axis
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit vector
  double radius = 0.15;
};

/// Distance along the beam at `angle` (rad) in the scan plane z = 0 to the cylinder's near side; nothing when
/// the beam misses, or starts inside.
std::optional<double> beamRange(const LegCylinder& leg, double angle);

/// The ellipse in which the scan plane cuts the cylinder.
struct LegEllipse {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m, scanner frame
  double semi_minor = 0.0;                           ///< m, the cylinder's radius
  double semi_major = 0.0;  ///< m, radius / cos(tilt against the scan plane's normal)
};
LegEllipse cutByScanPlane(const LegCylinder& leg);

}  // namespace pos::sim
