#pragma once
/// How wide and high a roadway has to be for its vehicles (Yang et al., eqs. 22-23, corrected).

#include <optional>
#include <string>
#include <vector>

#include "pos/map/roadway.hpp"

namespace pos::map {

/// Outer size of a vehicle with its load.
struct VehicleSize {
  double width = 0.0;   ///< m
  double height = 0.0;  ///< m, above the floor
};

/// What the regulations ask for, m.
struct ClearanceRules {
  double wall_gap = 0.3;     ///< a: vehicle to the wall without walkway
  double walkway = 0.8;      ///< C: vehicle to the wall with the walkway
  double meeting_gap = 0.2;  ///< t: between vehicles that meet
  double roof_gap = 0.5;     ///< above the vehicle's upper corners
};
ClearanceRules validated(ClearanceRules rules);

/// Needed width, m. Two lanes: B2 = a + A1 + A2 + C + t. One lane: B1 = a + A1 + C.
double neededWidth(int lanes, const VehicleSize& vehicle, const VehicleSize& meeting,
                   const ClearanceRules& rules);

/// One rule applied to one roadway.
struct ClearanceRow {
  std::string rule = {};  ///< "width", "roof over the wall gap", ...
  double needed = 0.0;    ///< m
  double found = 0.0;     ///< m
  double slack() const { return found - needed; }
  bool violated() const { return slack() < -1e-9; }
};

struct ClearanceReport {
  std::vector<ClearanceRow> rows = {};  ///< every rule, also those that hold
  std::vector<ClearanceRow> violations() const;
};
/// With the vehicle at `wall_gap` from one wall; two lanes: two of them meeting. The section's roof is
/// compared at the vehicle's upper corners.
ClearanceReport clearance(const Roadway& roadway, const VehicleSize& vehicle, const ClearanceRules& rules);

/// Height of the section's roof at an offset from the centreline, m; 0 beyond the walls.
double roofHeight(const Roadway& roadway, double offset);

}  // namespace pos::map
