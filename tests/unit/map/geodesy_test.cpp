#include "pos/map/geodesy.hpp"

#include <gtest/gtest.h>

#include "pos/core/angle.hpp"

namespace pos::map {
namespace {

const GeodeticOrigin kPortal{radians(37.5), radians(112.25), 830.0, 0.0};

}  // namespace

TEST(LocalFrame, TheOriginIsZero) {
  const LocalFrame frame(kPortal);
  EXPECT_LT(frame.fromGeodetic(kPortal.latitude, kPortal.longitude, kPortal.altitude).norm(), 1e-9);
}

TEST(LocalFrame, SmallStepsFollowTheRadiiOfCurvature) {
  // WGS84: radius along the meridian M and across it N at the origin's latitude.
  constexpr double kA = 6378137.0;
  constexpr double kE2 = 6.69437999014e-3;
  const double s = std::sin(kPortal.latitude);
  const double N = kA / std::sqrt(1.0 - kE2 * s * s);
  const double M = kA * (1.0 - kE2) / std::pow(1.0 - kE2 * s * s, 1.5);
  const LocalFrame frame(kPortal);
  const double step = 1e-5;  // rad, about 64 m
  const Eigen::Vector3d north =
      frame.fromGeodetic(kPortal.latitude + step, kPortal.longitude, kPortal.altitude);
  EXPECT_NEAR(north.y(), step * (M + kPortal.altitude), 1e-3);
  EXPECT_NEAR(north.x(), 0.0, 1e-6);
  const Eigen::Vector3d east =
      frame.fromGeodetic(kPortal.latitude, kPortal.longitude + step, kPortal.altitude);
  EXPECT_NEAR(east.x(), step * (N + kPortal.altitude) * std::cos(kPortal.latitude), 1e-3);
  EXPECT_NEAR(frame.fromGeodetic(kPortal.latitude, kPortal.longitude, kPortal.altitude + 12.0).z(), 12.0,
              1e-9);
}

TEST(LocalFrame, GridRotationTurnsTheMapCounterClockwiseFromEast) {
  GeodeticOrigin turned = kPortal;
  turned.grid_rotation = radians(90.0);  // the map's x axis looks north
  const Eigen::Vector3d north =
      LocalFrame(turned).fromGeodetic(kPortal.latitude + 1e-5, kPortal.longitude, kPortal.altitude);
  EXPECT_GT(north.x(), 60.0);
  EXPECT_NEAR(north.y(), 0.0, 1e-6);
}

TEST(LocalFrame, ThereAndBackIsTheSamePoint) {
  GeodeticOrigin turned = kPortal;
  turned.grid_rotation = radians(-17.0);
  const LocalFrame frame(turned);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(1234.5, -987.6, -310.0),
                                   Eigen::Vector3d(-40000.0, 25000.0, 120.0)}) {
    const GeodeticOrigin g = frame.toGeodetic(p);
    EXPECT_LT((frame.fromGeodetic(g.latitude, g.longitude, g.altitude) - p).norm(), 1e-6);
  }
}

}  // namespace pos::map
