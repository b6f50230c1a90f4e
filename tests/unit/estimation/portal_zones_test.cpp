#include "pos/estimation/portal_zones.hpp"

#include <gtest/gtest.h>

namespace pos::estimation {
namespace {

/// A road along x with the portal at 100 m, hand-over 80 to 200 m, and a drift without a portal.
std::shared_ptr<map::TunnelMap> mine() {
  auto mine = std::make_shared<map::TunnelMap>();
  mine->name = "mine";
  map::Roadway road;
  road.id = "road";
  road.centreline = {{.p_map = {0, 0, 0}}, {.p_map = {400, 0, -40}}};
  road.width = 5;
  road.height = 4;
  map::Roadway drift = road;
  drift.id = "drift";
  drift.centreline = {{.p_map = {300, 50, -30}}, {.p_map = {300, 150, -30}}};
  mine->roadways = {road, drift};
  mine->portals = {{.id = "P", .place = {"road", 100.0}, .handover_from = 80.0, .handover_to = 200.0}};
  return mine;
}

}  // namespace

TEST(PortalZones, FollowTheRoadIntoTheRock) {
  const PortalZones zones(mine());
  EXPECT_EQ(zones.at({10, 0, -1}, 0.1, 1.0), Zone::Surface);
  EXPECT_EQ(zones.at({100, 1, -10}, 0.1, 1.0), Zone::Handover);
  EXPECT_EQ(zones.at({250, 1, -25}, 0.1, 1.0), Zone::Underground);
  EXPECT_EQ(zones.at({300, 100, -30}, 0.1, 1.0), Zone::Underground);
}

TEST(PortalZones, DarknessWaitsForMarginAndForThreeSigma) {
  const PortalZones zones(mine());
  const Eigen::Vector3d just_beyond(201.0, 0, -20);  // 202 m along the slope
  EXPECT_EQ(zones.at(just_beyond, 0.1, 1.0), Zone::Underground);
  EXPECT_EQ(zones.at(just_beyond, 0.1, 3.0), Zone::Handover);
  EXPECT_EQ(zones.at(just_beyond, 1.0, 1.0), Zone::Handover);
  EXPECT_EQ(zones.at(just_beyond, 20.0, 1.0), Zone::Unknown);
}

TEST(PortalZones, ARoadMeasuredFromTheInsideTurnsThemRound) {
  auto other = mine();
  other->portals[0].place.chainage = 190.0;
  const PortalZones zones(other);
  EXPECT_EQ(zones.at({10, 0, -1}, 0.1, 1.0), Zone::Underground);
  EXPECT_EQ(zones.at({300, 0, -30}, 0.1, 1.0), Zone::Surface);
}

TEST(PortalZones, AMapWithoutPortalsKnowsNothing) {
  auto bare = mine();
  bare->portals.clear();
  EXPECT_EQ(PortalZones(bare).at({250, 0, -25}, 0.1, 1.0), Zone::Unknown);
  EXPECT_EQ(PortalZones(nullptr).at({250, 0, -25}, 0.1, 1.0), Zone::Unknown);
}

TEST(PortalZones, FloorIsTheCentrelinesHeightOnTheRoadOnly) {
  const PortalZones zones(mine());
  EXPECT_NEAR(*zones.floorAt({200, 1, -19}), -20.0, 0.11);
  EXPECT_FALSE(zones.floorAt({200, 60, -20}));
}

}  // namespace pos::estimation
