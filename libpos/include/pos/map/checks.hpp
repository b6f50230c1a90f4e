#pragma once
/// What a surveyor should look at before a map is used. Things that make a map unusable (an id given twice, a
/// roadway that does not exist) are refused by `validated`; these checks are about maps that load and are
/// wrong.

#include <string>
#include <string_view>
#include <vector>

#include "pos/map/clearance.hpp"
#include "pos/map/network.hpp"

namespace pos::map {

enum class Severity { Error, Warning, Note };
std::string_view name(Severity severity);

/// Kind of a finding; its name is the word printed and written to JSON.
enum class Check {
  NearCoincidentNodes,
  Gap,
  ReversedChainage,
  StationMismatch,
  ChainageOutside,
  AnchorOutside,
  AnchorFarFromWall,
  AnchorsCoincide,
  FewAnchors,
  SectionWithoutChamber,
  SectionWithoutLights,
  UnreachableNode,
  NoCapacity,
  ChamberTooShort,
  UndeclaredCrossing,
  CrossingClearance,
  CrossingNotThere,
  SteepGrade,
  UndeclaredBend,
  BendNotThere,
  RouteBroken,
  TooNarrow,
  TooLow
};
std::string_view name(Check check);

struct Finding {
  Check check = Check::Gap;
  Severity severity = Severity::Error;
  std::string what = {};                            ///< one sentence with the ids concerned
  std::string remedy = {};                          ///< what to do
  std::vector<std::string> objects = {};            ///< ids concerned, "roadway R1"
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< m, where to look
};

struct CheckRules {
  double coincident = 0.5;         ///< m, nodes or anchors nearer than this are one
  double gap = 0.2;                ///< m, places joined by a junction may be this far apart
  double open_end_reach = 3.0;     ///< m, an open end this near to another roadway's wall looks forgotten
  double station_tolerance = 1.0;  ///< m, surveyed station against length
  double wall_distance = 0.6;      ///< m, an anchor farther from wall, roof and floor hangs in the air
  double anchor_slack = 0.15;      ///< m, an anchor may be this deep in the rock
  double section_without_chamber = 100.0;  ///< m, the longest single lane that needs none
  double sample_step = 5.0;                ///< m of chainage
  double rock_between = 2.0;               ///< m, roof to floor at a crossing
  double light_reach = 30.0;               ///< m, lights stand within this of a section's ends
  double steepest_grade = 0.45;            ///< rise per metre of plan
  double bend_angle = 0.52;                ///< rad, turns of more than this are bends
  ClearanceRules clearance = {};
};
CheckRules validated(CheckRules rules);

/// All findings, errors first, then in map order. What has to be visible and which vehicles have to fit comes
/// from the map's own requirements.
std::vector<Finding> findings(const Network& network, const CheckRules& rules);

}  // namespace pos::map
