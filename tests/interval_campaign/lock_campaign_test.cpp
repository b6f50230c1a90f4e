/// The lock safety campaign: a hundred thousand requests by twenty vehicles.

#include <gtest/gtest.h>

#include "pos/io/map_yaml.hpp"
#include "support/lock_mine.hpp"
#include "support/traffic_figures.hpp"

namespace pos::interval {
namespace {

/// Ways between all ends, and the map's own routes in both directions (a round trip has no shortest way).
std::vector<Way> allWays(const testing::LockMine& mine) {
  std::vector<Way> ways = mine.ways();
  const std::vector<Way> routes = traffic::waysOfRoutes(mine.network, mine.locks);
  ways.insert(ways.end(), routes.begin(), routes.end());
  return ways;
}

void campaign(const testing::LockMine& mine, const traffic::TrafficOptions& options) {
  const auto result = traffic::runTraffic(mine.locks.site(), allWays(mine), {}, options);
  testing::print(result);
  testing::expectSafe(result);
  EXPECT_GE(result.tally.requests, options.requests);
  EXPECT_GE(result.lockSuccess(), 0.995);
}

}  // namespace

TEST(LockCampaign, AHundredThousandRequestsByTwentyVehiclesInTheShiftMine) {
  const auto map = io::readMapFile(std::filesystem::path(POS_SOURCE_DIR) / "maps/shift_mine/map.yaml").map;
  campaign(testing::LockMine(std::make_shared<const map::TunnelMap>(map)),
           {.seed = 11, .vehicles = 20, .requests = 100000});
}

TEST(LockCampaign, ThirtyThousandRequestsInASmallCrowdedMine) {
  campaign(testing::LockMine(testing::lockMine()), {.seed = 11, .vehicles = 20, .requests = 30000});
}

}  // namespace pos::interval
