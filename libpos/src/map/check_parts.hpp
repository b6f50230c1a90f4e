#pragma once
/// The groups of checks that `findings` runs, one after the other.

#include "pos/map/checks.hpp"
#include "pos/map/routes.hpp"

namespace pos::map {

using Findings = std::vector<Finding>;

/// "12.3", for messages.
std::string metres(double value);

// check_centrelines.cpp: one roadway at a time
Findings nearPoints(const Network& network, const CheckRules& rules);
Findings stations(const Network& network, const CheckRules& rules);
Findings grades(const Network& network, const CheckRules& rules);
Findings bends(const Network& network, const CheckRules& rules);
Findings clearances(const Network& network, const CheckRules& rules);

// check_joints.cpp: how roadways meet
Findings chainagesOutside(const Network& network);
Findings nodes(const RoadGraph& graph, const CheckRules& rules);
Findings junctionGaps(const Network& network, const CheckRules& rules);
Findings openEnds(const Network& network, const RoadGraph& graph, const CheckRules& rules);
Findings unreachable(const RoadGraph& graph);
Findings routes(const Network& network, const CheckRules& rules);

// check_crossings.cpp
Findings crossings(const Network& network, const CheckRules& rules);

// check_furniture.cpp: anchors, chambers, lights
Findings anchors(const Network& network, const CheckRules& rules);
Findings anchorCounts(const Network& network, const CheckRules& rules);
Findings chambers(const Network& network);
Findings sections(const Network& network, const RoadGraph& graph, const CheckRules& rules);

}  // namespace pos::map
