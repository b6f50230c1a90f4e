#include <cmath>

#include "unit/sim/motion_checks.hpp"
#include "unit/sim/paper_motions.hpp"

namespace pos::sim {
namespace {

struct Named {
  std::string name;
  MotionConfig config;
  double h;  ///< s, step of the differences
};

std::vector<Named> allMotions() {
  return {{"lane_shift", papers::laneShift(), 0.01},
          {"quarter_turn", papers::quarterTurn(), 0.01},
          {"circle", papers::circle(), 0.01},
          {"incline", papers::incline(), 0.01},
          {"curve", papers::curve(), 0.01},
          {"loop", papers::loop(), 0.01},
          {"rope", papers::rope(), 0.01},
          {"branch", papers::branch(), 0.01},
          {"mock_shaft", papers::mockShaft(), 0.01},
          {"shift", papers::shift(), 0.02},
          {"shearer", papers::shearerRun(), 0.2}};
}

class EveryMotion : public testing::TestWithParam<Named> {};

std::string nameOf(const testing::TestParamInfo<Named>& info) {
  return info.param.name;
}

}  // namespace

TEST_P(EveryMotion, DerivativesAreThoseOfPositionAndAttitude) {
  const auto motion = makeMotion(GetParam().config);
  const Disagreement worst = disagreement(*motion, 997, GetParam().h);
  // Rounding of a position of 3 km over the step of 20 ms, with the formula's factor of 1.8.
  constexpr double kTolerance = 1e-10;
  EXPECT_GT(worst.compared, 500);
  EXPECT_LT(worst.velocity, kTolerance);
  EXPECT_LT(worst.acceleration, kTolerance);
  EXPECT_LT(worst.rate, kTolerance);
  EXPECT_LT(worst.angular_acceleration, kTolerance);
  EXPECT_LT(worst.travelled, kTolerance);
  EXPECT_LT(worst.rotation, 1e-14);
}

TEST_P(EveryMotion, PositionAndAttitudeNeverJump) {
  expectContinuous(*makeMotion(GetParam().config));
}

TEST_P(EveryMotion, StandsStillBeforeTheStartAndAfterTheEnd) {
  const auto motion = makeMotion(GetParam().config);
  for (const auto& [outside, edge] :
       {std::pair(-3.0, 0.0), std::pair(motion->duration() + 3.0, motion->duration())}) {
    const Kinematics body = motion->at(outside);
    EXPECT_EQ(body.p_map, motion->at(edge).p_map);
    EXPECT_EQ(body.v_map.norm() + body.a_map.norm() + body.omega_body.norm() + body.alpha_body.norm(), 0.0);
    EXPECT_EQ(motion->travelled(outside), motion->travelled(edge));
  }
}

INSTANTIATE_TEST_SUITE_P(Papers, EveryMotion, testing::ValuesIn(allMotions()), nameOf);

TEST(PaperMotions, LaneShiftEndsInItsOwnLaneAndLeavesItBy1568Millimetres) {
  const auto motion = makeMotion(papers::laneShift());
  EXPECT_NEAR(motion->duration(), 30.0, 1e-12);
  EXPECT_NEAR(motion->at(30.0).p_map.x(), 23.945, 5e-4);
  // The ramp of 0.98626 s is rounded to 5e-6 s; dW / dr = 2 (1 - cos p) / p - 2 sin p = -0.384 m/s.
  EXPECT_NEAR(motion->at(30.0).p_map.y(), 0.0, 2e-6);
  EXPECT_NEAR(motion->at(16.0).p_map.y(), -1.5682, 5e-5);
  EXPECT_NEAR(motion->at(9.0).omega_body.z(), -0.2, 1e-12);
  EXPECT_NEAR(motion->at(19.5).omega_body.z(), 0.4 / 0.98626, 1e-12);
}

TEST(PaperMotions, QuarterTurnPassesItsThreePlaces) {
  const auto motion = makeMotion(papers::quarterTurn());
  EXPECT_NEAR(motion->at(20.0).p_map.x(), 7.000, 5e-6);
  EXPECT_NEAR(motion->at(25.0).p_map.x(), 10.0, 1e-5);
  EXPECT_NEAR(motion->at(25.0).p_map.y(), -3.0, 1e-9);
  const Kinematics end = motion->at(35.0);
  EXPECT_NEAR(std::atan2(end.R_map_body(1, 0), end.R_map_body(0, 0)), -0.5 * kPi, 1e-12);
  EXPECT_NEAR(end.p_map.y(), -12.42, 5e-3);
}

TEST(PaperMotions, CircleComesBackToWhereItLeftTheStraight) {
  const auto motion = makeMotion(papers::circle());
  EXPECT_NEAR(motion->duration(), 72.83, 5e-3);
  EXPECT_LT((motion->at(motion->duration()).p_map - Eigen::Vector3d(20, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR((motion->at(40.0).p_map - Eigen::Vector3d(20, 20, 0)).norm(), 20.0, 1e-12);
  EXPECT_NEAR(motion->travelled(motion->duration()), 20.0 + 40.0 * kPi, 1e-11);
}

TEST(PaperMotions, InclineEndsAtThePrintedPoint) {
  const auto motion = makeMotion(papers::incline());
  EXPECT_DOUBLE_EQ(motion->duration(), 75.0);
  EXPECT_LT((motion->at(75.0).p_map - Eigen::Vector3d(374.35, 0, -13.94)).cwiseAbs().maxCoeff(), 5e-3);
  for (const auto& [t, way] :
       {std::pair(10.0, 0.0), std::pair(15.0, 25.0), std::pair(20.0, 75.0), std::pair(30.0, 150.0),
        std::pair(50.0, 250.0), std::pair(70.0, 350.0), std::pair(75.0, 375.0)}) {
    EXPECT_NEAR(motion->travelled(t), way, 1e-12);
  }
  // FLU: a nose that goes down turns about +y.
  EXPECT_NEAR(motion->at(40.0).omega_body.y(), radians(0.4), 1e-15);
  EXPECT_NEAR(motion->at(50.0).R_map_body(2, 0), std::sin(radians(-8)), 1e-15);
}

TEST(PaperMotions, CurveEndsAtB) {
  const auto motion = makeMotion(papers::curve());
  const Kinematics end = motion->at(motion->duration());
  EXPECT_NEAR(end.p_map.x(), 2.008, 5e-4);
  EXPECT_NEAR(end.p_map.y(), 4.805, 5e-4);
  EXPECT_NEAR(motion->travelled(37.0), 6.2, 1e-12);
  EXPECT_NEAR(degrees(std::atan2(end.R_map_body(1, 0), end.R_map_body(0, 0))), 72.8, 1e-10);
  EXPECT_NEAR(motion->at(16.0).omega_body.z(), radians(110) / 19.0, 1e-12);
}

TEST(PaperMotions, LoopComesBackNearItsStart) {
  const auto motion = makeMotion(papers::loop());
  EXPECT_DOUBLE_EQ(motion->duration(), 75.0);
  EXPECT_NEAR(motion->at(75.0).p_map.x(), 0.40, 5e-3);
  EXPECT_NEAR(motion->at(75.0).p_map.y(), 0.00, 5e-3);
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  for (double t = 0.0; t < 75.0; t += 0.05) {
    low = low.cwiseMin(motion->at(t).p_map);
    high = high.cwiseMax(motion->at(t).p_map);
  }
  EXPECT_NEAR(low.x(), -6.0, 0.05);
  EXPECT_NEAR(high.x(), 2.0, 0.05);
  EXPECT_NEAR(low.y(), -1.1, 0.05);
  EXPECT_NEAR(high.y(), 6.9, 0.05);
}

TEST(PaperMotions, RopeHoldsTheCarAtOneMetre) {
  const auto motion = makeMotion(papers::rope());
  EXPECT_NEAR(motion->at(7.0).p_map.x(), 1.0, 2e-3);
  EXPECT_EQ(motion->at(10.0).v_map.norm(), 0.0);
}

}  // namespace pos::sim
