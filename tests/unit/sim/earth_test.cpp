#include "pos/sim/earth.hpp"

#include <gtest/gtest.h>

#include "pos/core/angle.hpp"
#include "unit/sim/refusals.hpp"

namespace pos::sim {

TEST(Earths, FlatIsConstantAndDoesNotTurn) {
  const Earth earth({.gravity = 9.7});
  EXPECT_EQ(earth.gravityAt({5000, 1, -300}), Eigen::Vector3d(0, 0, -9.7));
  EXPECT_EQ(earth.rotation().norm(), 0.0);
  EXPECT_TRUE(earth.uniform());
}

TEST(Earths, TheMapTurnsAboutThePole) {
  // At 60 degrees north, with the map's x axis turned 90 degrees towards north: x looks to the pole.
  const Earth earth(
      {.kind = EarthKind::Level, .origin = {.latitude = radians(60), .grid_rotation = radians(90)}});
  const Eigen::Vector3d pole(std::cos(radians(60)), 0.0, std::sin(radians(60)));
  EXPECT_LT((earth.rotation() - 7.292115e-5 * pole).norm(), 1e-14);
}

TEST(Earths, GravityGrowsTowardsThePoleAndFadesWithHeight) {
  const auto g = [](double latitude_deg, double altitude) {
    return Earth({.kind = EarthKind::Level,
                  .origin = {.latitude = radians(latitude_deg), .altitude = altitude}})
        .gravityAt({0, 0, 0})
        .norm();
  };
  EXPECT_NEAR(g(0, 0), 9.7803253359, 1e-9);
  EXPECT_NEAR(g(90, 0), 9.8321849379, 1e-9);
  EXPECT_NEAR(g(35, 1000) - g(35, 0), -3.086e-3, 3e-6);
}

TEST(Earths, ThePlumbLineLeansBackTowardsTheOriginWithDistance) {
  const Earth earth({.kind = EarthKind::Ellipsoid, .origin = {.latitude = radians(35)}});
  EXPECT_FALSE(earth.uniform());
  EXPECT_LT(earth.gravityAt({0, 0, 0}).head<2>().norm(), 1e-12);
  const Eigen::Vector3d east = earth.gravityAt({6000, 0, 0});
  // Distance over the radius across the meridian: 6000 / 6 385 200 of g.
  EXPECT_NEAR(east.x(), -9.7973 * 6000.0 / 6385200.0, 3e-6);
  EXPECT_NEAR(earth.gravityAt({0, 0, -500}).z() - earth.gravityAt({0, 0, 0}).z(), -500 * 3.086e-6, 3e-6);
}

TEST(Earths, RefusesWhatIsNoPlace) {
  EXPECT_EQ(refusedKey([] { return Earth({.gravity = 0.0}); }), "gravity");
  EXPECT_EQ(refusedKey([] { return Earth({.kind = EarthKind::Level, .origin = {.latitude = 35.0}}); }),
            "origin.latitude");
}

}  // namespace pos::sim
