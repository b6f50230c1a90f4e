#include "pos/lidar/leg_association.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pos/core/random.hpp"
#include "pos/lidar/legs.hpp"

namespace pos::lidar {

// Spec B, eq. 3 of the paper: supports lie at negative x_s, and the turn keeps its hand.
TEST(SensorAxes, SupportsLieAtNegativeX) {
  const Eigen::Vector2d s = sensorAxes({2.0, 4.0});
  EXPECT_EQ(s, Eigen::Vector2d(-4.0, 2.0));
  Eigen::Matrix2d C;
  C << sensorAxes({1.0, 0.0}), sensorAxes({0.0, 1.0});
  EXPECT_EQ(C.determinant(), 1.0);
}

TEST(LegAssociation, NearestWithinTheGate) {
  const std::vector<PredictedLeg> lattice{{7, {0.0, 4.0}}, {8, {1.5, 4.0}}, {9, {3.0, 4.0}}};
  const std::vector<Eigen::Vector2d> seen{{1.4, 4.1}, {3.45, 4.0}, {2.25, 4.0}, {0.0, 4.6}};
  const auto answers = associated(seen, lattice);
  ASSERT_EQ(answers.size(), 4U);
  EXPECT_EQ(answers[0].match, LegMatch::Matched);
  EXPECT_EQ(lattice[static_cast<std::size_t>(answers[0].predicted)].support, 8);
  EXPECT_NEAR(answers[0].distance, std::hypot(0.1, 0.1), 1e-12);
  EXPECT_EQ(answers[1].match, LegMatch::Matched);
  EXPECT_EQ(answers[1].predicted, 2);
  EXPECT_EQ(answers[2].match, LegMatch::Far);  // 0.75 from both
  EXPECT_EQ(answers[3].match, LegMatch::Far);
}

TEST(LegAssociation, DropsWhatIsNotClear) {
  const std::vector<PredictedLeg> close{{1, {0.0, 4.0}}, {2, {0.6, 4.0}}, {3, {5.0, 4.0}}};
  const std::vector<Eigen::Vector2d> seen{{0.3, 4.0}, {4.9, 4.0}, {5.2, 4.1}, {std::nan(""), 4.0}};
  const auto answers = associated(seen, close);
  EXPECT_EQ(answers[0].match, LegMatch::Ambiguous);
  EXPECT_EQ(answers[1].match, LegMatch::Contested);
  EXPECT_EQ(answers[2].match, LegMatch::Contested);
  EXPECT_EQ(answers[3].match, LegMatch::Far);
  EXPECT_EQ(associated(seen, {})[0].predicted, -1);
}

TEST(LegAssociation, OrderDoesNotMatter) {
  RandomStream random(5, 5);
  std::vector<PredictedLeg> lattice;
  std::vector<Eigen::Vector2d> seen;
  for (int i = 0; i < 12; ++i) {
    lattice.push_back({i, {1.5 * i, 4.0}});
    const double dx = random.normal(0.0, 0.4);
    seen.emplace_back(1.5 * i + dx, 4.0);
  }
  const auto forward = associated(seen, lattice);
  std::vector<Eigen::Vector2d> reversed(seen.rbegin(), seen.rend());
  const auto backward = associated(reversed, lattice);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(forward[i].match, backward[seen.size() - 1 - i].match);
    EXPECT_EQ(forward[i].predicted, backward[seen.size() - 1 - i].predicted);
  }
}

}  // namespace pos::lidar
