#include "pos/ins/earth.hpp"

#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>

namespace pos::ins {
namespace {

constexpr double kDegree = M_PI / 180.0;

TEST(Earth, NormalGravityAgreesWithGeographicLib) {
  for (const double latitude_deg : {-60.0, -5.0, 0.0, 20.0, 35.0, 50.0, 89.0}) {
    for (const double height : {-1000.0, 0.0, 3000.0}) {
      double up_y = 0.0;
      double up = 0.0;
      GeographicLib::NormalGravity::WGS84().Gravity(latitude_deg, height, up_y, up);
      EXPECT_NEAR(normalGravity(latitude_deg * kDegree, height), -up, 2e-6) << latitude_deg << " " << height;
    }
  }
}

TEST(Earth, MetricIsTheDistancePerUnitOfEachCoordinate) {
  const Earth earth = Earth::ellipsoid();
  const GeographicLib::Geocentric& geocentric = GeographicLib::Geocentric::WGS84();
  const auto xyz = [&](const Eigen::Vector3d& q) {
    Eigen::Vector3d p;
    geocentric.Forward(q.y() / kDegree, q.x() / kDegree, q.z(), p.x(), p.y(), p.z());
    return p;
  };
  for (const double latitude : {-0.9, 0.0, 0.61, 1.3}) {
    const Eigen::Vector3d q(1.9, latitude, 250.0);
    const Eigen::Vector3d metric = earth.at(q).metric;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d d = Eigen::Vector3d::Zero();
      d[axis] = axis == 2 ? 0.5 : 1e-6;
      const double moved = (xyz(q + d) - xyz(q - d)).norm();
      EXPECT_NEAR(metric[axis], moved / (2.0 * d[axis]), 1e-6 * metric[axis]) << latitude << " " << axis;
    }
  }
}

TEST(Earth, SlopesAreTheDerivativesOfWhatTheyBelongTo) {
  const Earth earth = Earth::ellipsoid();
  const Eigen::Vector3d q(0.3, 0.61, -400.0);
  const EarthPoint here = earth.at(q);
  const double step = 1e-5;
  const EarthPoint north = earth.at(q + Eigen::Vector3d(0.0, step, 0.0));
  const EarthPoint south = earth.at(q - Eigen::Vector3d(0.0, step, 0.0));
  const double metres = 2.0 * step * here.metric.y();
  EXPECT_NEAR(here.gravity_by_north, (north.gravity - south.gravity) / metres, 1e-13);
  EXPECT_NEAR(here.omega_ie_by_north_y, (north.omega_ie.y() - south.omega_ie.y()) / metres, 1e-19);
  EXPECT_NEAR(here.omega_ie_by_north_z, (north.omega_ie.z() - south.omega_ie.z()) / metres, 1e-19);
  const EarthPoint above = earth.at(q + Eigen::Vector3d(0.0, 0.0, 1.0));
  EXPECT_NEAR(here.gravity_by_height, above.gravity - here.gravity, 1e-11);
}

TEST(Earth, FlatEarthNeitherTurnsNorCurves) {
  const EarthPoint here = Earth::flat(9.8).at({100.0, 200.0, 300.0});
  EXPECT_EQ(here.gravity, 9.8);
  EXPECT_EQ(here.omega_ie.norm(), 0.0);
  EXPECT_EQ(here.omega_en({3.0, 4.0, 5.0}).norm(), 0.0);
  EXPECT_EQ(here.metric, Eigen::Vector3d::Ones());
}

}  // namespace
}  // namespace pos::ins
