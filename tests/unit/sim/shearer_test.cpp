#include <cmath>

#include "unit/sim/motion_checks.hpp"
#include "unit/sim/paper_motions.hpp"
#include "unit/sim/refusals.hpp"

namespace pos::sim {
namespace {

constexpr double kCycle = 3540.0 + 872.0;

double heading(const Kinematics& body) {
  return std::atan2(body.R_map_body(1, 0), body.R_map_body(0, 0));
}

}  // namespace

TEST(Shearer, TimetableOfSixPassesAndFiveDwells) {
  const auto shearer = makeShearerMotion({});
  EXPECT_NEAR(shearer->duration(), 25600.0, 1e-9);
  for (int pass = 0; pass < 6; ++pass) {
    const double end = pass % 2 == 0 ? 350.0 : 0.0;
    EXPECT_NEAR(shearer->stationAt(pass * kCycle), 350.0 - end, 1e-9);
    EXPECT_NEAR(shearer->stationAt(pass * kCycle + 3540.0), end, 1e-9);
    EXPECT_EQ(shearer->lineAt(pass * kCycle + 100.0), pass);
    // One metre of advance a cycle; the line of pass c lies at c metres.
    EXPECT_NEAR(shearer->at(pass * kCycle + 1770.0).p_map.x(), pass * 1.0, 1e-12);
    EXPECT_NEAR(std::abs(shearer->at(pass * kCycle + 1770.0).v_map.y()), 0.0989, 1e-4);
  }
}

TEST(Shearer, DwellGoesAwayFromTheEndAndComesBackOnTheNewLine) {
  const auto shearer = makeShearerMotion({.creep = {-0.176}});
  const double start = 3540.0;
  EXPECT_NEAR(shearer->stationAt(start + 436.0), 350.0 - 43.1, 1e-9);
  EXPECT_NEAR(shearer->stationAt(start + 872.0), 350.0, 1e-9);
  // Outbound at 9 m from the end: old line; halfway in the S-bend: half of both; at 36 m: new line.
  for (double t = start; t < start + 431.0; t += 0.5) {
    const double away = 350.0 - shearer->stationAt(t);
    const Eigen::Vector3d p = shearer->at(t).p_map;
    const double share = away <= 10   ? 0.0
                         : away >= 35 ? 1.0
                                      : 0.5 * (1.0 - std::cos(kPi * (away - 10.0) / 25.0));
    EXPECT_NEAR(p.x(), share, 1e-12);
    EXPECT_NEAR(p.y(), 350.0 - away - 0.176 * share, 1e-9);
  }
  for (double t = start + 441.0; t < start + 872.0; t += 0.5)
    EXPECT_NEAR(shearer->at(t).p_map.x(), 1.0, 1e-12);
  // Ten seconds at each of the three reversals.
  for (const double t : {start + 5.0, start + 436.0, start + 867.0})
    EXPECT_EQ(shearer->at(t).v_map.norm(), 0.0);
}

TEST(Shearer, BodyLooksToEnd2AlsoOnTheWayBack) {
  const auto shearer = makeShearerMotion({.passes = 2});
  EXPECT_NEAR(heading(shearer->at(1000.0)), 0.5 * kPi, 1e-12);
  EXPECT_NEAR(heading(shearer->at(kCycle + 1000.0)), 0.5 * kPi, 1e-12);
  EXPECT_LT(shearer->at(kCycle + 1000.0).v_map.y(), 0.0);
  EXPECT_GT(shearer->travelled(3540.0), shearer->travelled(kCycle + 3000.0));
}

TEST(Shearer, BendAndFloorKeepToTheirPeakAndDifferFromLineToLine) {
  const auto shearer = makeShearerMotion(papers::shearerRun());
  double between = 0.0;
  for (int line = 0; line < 6; ++line) {
    double bend = 0.0;
    double floor = 0.0;
    for (double station = 0.0; station <= 350.0; station += 0.5) {
      const Eigen::Vector3d p = shearer->pointOnLine(line, station);
      bend = std::max(bend, std::abs(p.x() - line));
      floor = std::max(floor, std::abs(p.z()));
      if (line > 0)
        between = std::max(between, std::abs(p.x() - shearer->pointOnLine(line - 1, station).x() - 1.0));
    }
    EXPECT_NEAR(bend, 0.1, 1e-4);
    EXPECT_NEAR(floor, 0.1, 1e-4);
    EXPECT_NEAR(shearer->pointOnLine(line, 0.0).x(), line, 1e-12);
    EXPECT_NEAR(shearer->pointOnLine(line, 355.0).x(), line, 1e-12);
  }
  EXPECT_GT(between, 0.05);
}

TEST(Shearer, AttitudeFollowsTheConveyor) {
  const auto shearer = makeShearerMotion(papers::shearerRun());
  for (double t = 50.0; t < 25600.0; t += 37.0) {
    const Kinematics body = shearer->at(t);
    if (body.v_map.norm() < 1e-6) continue;
    EXPECT_NEAR(std::abs(body.R_map_body.col(0).dot(body.v_map.normalized())), 1.0, 1e-12);
    EXPECT_NEAR(body.R_map_body(2, 1), 0.0, 1e-15);  // no roll
  }
}

TEST(Shearer, CreepAddsUpAlongTheFace) {
  const auto shearer = makeShearerMotion(papers::shearerRun());
  const double creep[] = {0.0, -0.176, -0.401, -0.576, -0.801, -0.976};
  for (int line = 0; line < 6; ++line)
    EXPECT_NEAR(shearer->pointOnLine(line, 100.0).y(), 100.0 + creep[line], 1e-12);
}

TEST(Shearer, SupportsMoveOnBehindItAndTheLastOnesInTheEndOperation) {
  const auto shearer = makeShearerMotion({});
  const double t = 1770.0;
  const double station = shearer->stationAt(t);
  EXPECT_EQ(shearer->supportLine(station - 10.9, t), 0);
  EXPECT_EQ(shearer->supportLine(station - 11.1, t), 1);
  EXPECT_EQ(shearer->supportLine(station + 50.0, t), 0);
  EXPECT_EQ(shearer->supportLine(348.0, 3540.0 + 5.0), 0);
  EXPECT_EQ(shearer->supportLine(300.0, 3540.0 + 5.0), 1);
  EXPECT_EQ(shearer->supportLine(348.0, 3540.0 + 300.0), 0);  // 29 m away
  EXPECT_EQ(shearer->supportLine(348.0, 3540.0 + 400.0), 1);  // 39 m away
  EXPECT_EQ(shearer->supportLine(348.0, kCycle - 5.0), 1);
  const double back = kCycle + 1770.0;
  EXPECT_EQ(shearer->supportLine(shearer->stationAt(back) + 11.1, back), 2);
  EXPECT_EQ(shearer->supportLine(shearer->stationAt(back) - 11.1, back), 1);
}

TEST(Shearer, RefusesATimetableItCannotKeep) {
  EXPECT_EQ(refusedKey([] { return makeShearerMotion({.passes = 0}); }), "passes");
  EXPECT_EQ(refusedKey([] { return makeShearerMotion({.pass_time = 100.0}); }), "pass_time");
  EXPECT_EQ(refusedKey([] { return makeShearerMotion({.dwell_time = 60.0}); }), "dwell_time");
  EXPECT_EQ(refusedKey([] { return makeShearerMotion({.excursion = 30.0}); }), "s_bend_to");
  EXPECT_EQ(refusedKey([] { return makeShearerMotion({.inherited = 1.5}); }), "inherited");
}

}  // namespace pos::sim
