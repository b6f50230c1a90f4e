#include "pos/io/background.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

using ::testing::HasSubstr;

/// 0.5 m a pixel, turned by 0.3 rad, rows down.
Eigen::Vector2d placeOf(double column, double row) {
  const double c = 0.5 * std::cos(0.3), s = 0.5 * std::sin(0.3);
  return {100.0 + c * column + s * row, -40.0 + s * column - c * row};
}

std::vector<map::ControlPoint> points(double noise, std::uint64_t seed) {
  RandomStream random(seed, 2);
  std::vector<map::ControlPoint> all;
  for (const auto& [column, row] :
       {std::pair{0.0, 0.0}, {900.0, 20.0}, {880.0, 700.0}, {10.0, 650.0}, {400.0, 300.0}}) {
    const Eigen::Vector2d p = placeOf(column, row);
    all.push_back({column, row, p.x() + random.normal(0.0, noise), p.y() + random.normal(0.0, noise)});
  }
  return all;
}

TEST(Background, AnExactAffineIsFoundAgain) {
  const AffineFit fit = affineFit(points(0.0, 1));
  EXPECT_NEAR(fit.rms, 0.0, 1e-9);
  EXPECT_NEAR(fit.metres_per_pixel, 0.5, 1e-12);
  EXPECT_NEAR((fit.T_map_pixel * Eigen::Vector3d(123, 45, 1) - placeOf(123, 45)).norm(), 0.0, 1e-9);
}

TEST(Background, ResidualsAreThoseOfTheirPoints) {
  const auto control = points(0.5, 4);
  const AffineFit fit = affineFit(control);
  double sum = 0.0;
  for (std::size_t i = 0; i < control.size(); ++i) {
    const Eigen::Vector2d p = fit.T_map_pixel * Eigen::Vector3d(control[i].column, control[i].row, 1.0);
    EXPECT_NEAR(fit.residuals[i], std::hypot(p.x() - control[i].x, p.y() - control[i].y), 1e-9);
    sum += fit.residuals[i] * fit.residuals[i];
  }
  EXPECT_NEAR(fit.rms, std::sqrt(sum / 5.0), 1e-12);
  EXPECT_GT(fit.rms, 0.05);
}

TEST(Background, PointsOnOneLineAreRefused) {
  std::vector<map::ControlPoint> line{{0, 0, 0, 0}, {10, 10, 5, 5}, {20, 20, 10, 10}, {30, 30.001, 15, 15}};
  EXPECT_THAT(complaintOf<ConfigError>([&] { affineFit(line); }), HasSubstr("one line"));
  EXPECT_THAT(complaintOf<ConfigError>([&] { affineFit({}); }), HasSubstr("too few"));
}

TEST(Background, APictureThatIsNoneIsRefused) {
  const ScratchFolder folder;
  EXPECT_THROW(loadPicture(folder.write("a.png", "hello")), DataError);
  EXPECT_THROW(loadPicture(folder.path() / "none.png"), ConfigError);
  EXPECT_EQ(loadPicture(folder.write("a.pgm", "P2 2 1 255 0 255\n")).columns, 2);
}

}  // namespace
}  // namespace pos::io
