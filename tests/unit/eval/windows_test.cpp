#include "pos/eval/windows.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pos::eval {
namespace {

Stamp at(double t) {
  return stampFromSeconds(t);
}

ErrorSample sample(double t, double x, double y, double z) {
  ErrorSample s;
  s.stamp = at(t);
  s.x = {x, 0.0};
  s.y = {y, 0.0};
  s.z = ScalarError{z, 0.0};
  s.xy = std::hypot(x, y);
  return s;
}

}  // namespace

TEST(Windows, WindowsOfOneNameAreTakenTogetherAndBordersCount) {
  const ErrorSeries errors{sample(0.0, 9, 0, 0), sample(1.0, -3, 4, 12), sample(2.0, 1, 0, 0),
                           sample(3.0, 9, 9, 9), sample(4.0, 2, 0, 0)};
  const auto all =
      windowErrors(errors, {{"a", at(1.0), at(2.0)}, {"b", at(8.0), at(9.0)}, {"a", at(4.0), at(5.0)}});
  ASSERT_EQ(all.size(), 2U);
  const WindowErrors& a = all[0];
  EXPECT_EQ(a.errors[0].count, 3U);
  EXPECT_DOUBLE_EQ(a.errors[0].mean, 2.0);  // of |x|
  EXPECT_DOUBLE_EQ(a.errors[0].rmse, std::sqrt(14.0 / 3.0));
  EXPECT_DOUBLE_EQ(a.errors[0].max, 3.0);
  EXPECT_DOUBLE_EQ(a.errors[3].max, 5.0);   // xy
  EXPECT_DOUBLE_EQ(a.errors[4].max, 13.0);  // xyz
  EXPECT_EQ(all[1].errors[0].count, 0U);
}

TEST(Windows, WithoutHeightsThereAreNoFiguresInSpace) {
  ErrorSample flat = sample(1.0, 3, 4, 0);
  flat.z.reset();
  const auto all = windowErrors({flat}, {{"a", at(0.0), at(2.0)}});
  EXPECT_EQ(all[0].errors[2].count, 0U);
  EXPECT_EQ(all[0].errors[4].count, 0U);
  EXPECT_EQ(all[0].errors[3].count, 1U);
}

}  // namespace pos::eval
