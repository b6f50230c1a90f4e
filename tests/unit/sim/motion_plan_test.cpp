#include <cmath>

#include "unit/sim/motion_checks.hpp"
#include "unit/sim/paper_motions.hpp"
#include "unit/sim/refusals.hpp"

namespace pos::sim {
namespace {

std::string refusedSegments(const std::vector<Segment>& segments) {
  return refusedKey([&] { return makeMotion(SegmentMotionConfig{.segments = segments}); });
}

std::string refusedPath(const PathMotionConfig& config) {
  return refusedKey([&] { return makeMotion(config); });
}

std::string refusedRoute(const Route& route) {
  return refusedKey([&] { return routed(route); });
}

/// Everything at once, in each blend: nothing has a closed form here.
SegmentMotionConfig tangle(Blend blend) {
  Segment first{.drive = {.duration = 7, .speed_to = 3.0, .speed_blend = blend, .speed_ramp = 2.0},
                .turn = {.by = 2.5, .blend = blend, .ramp = 1.5, .wave_amplitude = 0.2, .wave_period = 3.0},
                .climb = {.by = 0.3, .blend = blend, .ramp = 3.0}};
  Segment second{.drive = {.length = 12.0, .speed_to = 0.5, .speed_blend = blend, .speed_ramp = 0.5},
                 .turn = {.by = -4.0, .blend = blend, .ramp = 0.25},
                 .climb = {.by = -0.5, .blend = blend, .ramp = 1.0}};
  return {.start = {.p_map = {5, -3, 2}, .heading = 2.0, .pitch = -0.1, .speed = 1.0},
          .segments = {first, second}};
}

}  // namespace

TEST(Segments, AnyTangleOfTurnsClimbsAndSpeedsHasExactDerivatives) {
  for (const Blend blend : {Blend::Linear, Blend::Trapezoid, Blend::Cosine, Blend::Smooth}) {
    const auto motion = makeMotion(tangle(blend));
    const Disagreement worst = disagreement(*motion, 400, 0.005);
    EXPECT_GT(worst.compared, 300);
    EXPECT_LT(worst.velocity, 1e-10);
    EXPECT_LT(worst.acceleration, 1e-10);
    EXPECT_LT(worst.rate, 1e-10);
    EXPECT_LT(worst.angular_acceleration, 1e-10);
    expectContinuous(*motion);
  }
}

TEST(Segments, PositionIsTheIntegralOfTheVelocity) {
  for (const Blend blend : {Blend::Linear, Blend::Trapezoid, Blend::Cosine, Blend::Smooth}) {
    const auto motion = makeMotion(tangle(blend));
    Eigen::Vector3d p = motion->at(0.0).p_map;
    constexpr int kSteps = 40000;
    const double dt = motion->duration() / kSteps;
    for (int i = 0; i < kSteps; ++i) {  // Simpson's rule
      p += dt / 6.0 *
           (motion->at(i * dt).v_map + 4.0 * motion->at((i + 0.5) * dt).v_map +
            motion->at((i + 1) * dt).v_map);
    }
    // A step over a break of the acceleration is wrong by jump * dt^2 / 12 at most; ten of them.
    EXPECT_LT((p - motion->at(motion->duration()).p_map).norm(), 10 * 5.0 * dt * dt / 12.0);
  }
}

TEST(Segments, ALengthTakesTheTimeOfTheMeanSpeed) {
  const auto motion = makeMotion(SegmentMotionConfig{
      .start = {.speed = 1.0},
      .segments = {{.drive = {.length = 8.0, .speed_to = 3.0, .speed_blend = Blend::Cosine}},
                   {.drive = {.until = 14.0}}}});
  EXPECT_DOUBLE_EQ(motion->duration(), 4.0 + 2.0);
  EXPECT_NEAR(motion->travelled(4.0), 8.0, 1e-13);
  EXPECT_NEAR(motion->travelled(6.0), 14.0, 1e-13);
}

TEST(Segments, SmoothAndCosineSpeedsStartAndEndWithoutAcceleration) {
  for (const Blend blend : {Blend::Cosine, Blend::Smooth}) {
    const auto motion = makeMotion(
        SegmentMotionConfig{.segments = {{.drive = {.duration = 2, .speed_to = 4, .speed_blend = blend}}}});
    EXPECT_NEAR(motion->at(0.0).a_map.x(), 0.0, 1e-12);
    EXPECT_NEAR(motion->at(2.0).a_map.x(), 0.0, 1e-12);
    EXPECT_NEAR(motion->at(1.0).a_map.x(), blend == Blend::Cosine ? kPi : 3.75, 1e-12);
  }
}

TEST(Segments, RefusalsNameTheEntry) {
  const Segment fine{.drive = {.duration = 1}};
  EXPECT_EQ(refusedSegments({}), "segments");
  EXPECT_EQ(refusedSegments({fine, {}}), "segments[1]");
  EXPECT_EQ(refusedSegments({{.drive = {.duration = 1, .length = 2}}}), "segments[0]");
  EXPECT_EQ(refusedSegments({{.drive = {.duration = 0.0}}}), "segments[0].duration");
  EXPECT_EQ(refusedSegments({{.drive = {.length = 3.0}}}), "segments[0].length");  // at rest
  EXPECT_EQ(refusedSegments({{.drive = {.duration = 1, .speed_to = NAN}}}), "segments[0].speed_to");
  EXPECT_EQ(refusedSegments({{.drive = {.duration = 1, .speed_to = 1.0, .speed_ramp = 0.6}}}),
            "segments[0].speed_ramp");
  EXPECT_EQ(refusedSegments({{.drive = {.duration = 1}, .turn = {.by = 1, .ramp = 0.6}}}),
            "segments[0].turn.ramp");
  EXPECT_EQ(refusedSegments({{.drive = {.duration = 1}, .turn = {.wave_amplitude = 1}}}),
            "segments[0].turn.wave_period");
  EXPECT_EQ(refusedSegments({{.drive = {.duration = 1}, .climb = {.by = 1.5}}}), "segments[0].climb");
}

TEST(Paths, RadiusGivesTheSmallestRadiusOfTheBend) {
  for (const Blend blend : {Blend::Linear, Blend::Trapezoid, Blend::Cosine, Blend::Smooth}) {
    const auto motion = makeMotion(PathMotionConfig{
        .start = {.speed = 2.0},
        .path = {{.radius = 12.0,
                  .turn = {.by = 1.2, .blend = blend, .ramp = blend == Blend::Trapezoid ? 3.0 : 0.0}}},
        .drive = {{}}});
    double fastest = 0.0;
    for (double t = 0.0; t <= motion->duration(); t += 0.001)
      fastest = std::max(fastest, motion->at(t).omega_body.z());
    EXPECT_NEAR(fastest, 2.0 / 12.0, 1e-6);
    const Kinematics end = motion->at(motion->duration());
    EXPECT_NEAR(std::atan2(end.R_map_body(1, 0), end.R_map_body(0, 0)), 1.2, 1e-9);
  }
}

TEST(Paths, AnOpenStepFillsThePathUpToTheStepsAfterIt) {
  const auto motion = makeMotion(PathMotionConfig{
      .path = {{.length = 100.0}},
      .drive = {{.duration = 4, .speed_to = 2.0}, {}, {.duration = 6, .speed_to = 0.0}, {.duration = 5}}});
  EXPECT_NEAR(motion->duration(), 4.0 + (100.0 - 4.0 - 6.0) / 2.0 + 6.0 + 5.0, 1e-12);
  EXPECT_NEAR(motion->at(motion->duration()).p_map.x(), 100.0, 1e-12);
}

TEST(Paths, DrivingBackRetracesThePathTurnedTheSameWay) {
  const PathMotionConfig config{
      .path = {{.length = 5.0}, {.length = 10.0, .turn = {.by = 1.0, .blend = Blend::Smooth}}},
      .drive = {{.duration = 2, .speed_to = 2.0},
                {.until = 12.0},
                {.duration = 4, .speed_to = -2.0},
                {.until = 1.0}}};
  const auto motion = makeMotion(config);
  const double turning = 2.0 + 5.0 + 2.0;  // s; the way is 14 m there
  for (const double before : {0.5, 1.7, 3.0}) {
    const Kinematics there = motion->at(turning - before);
    const Kinematics back = motion->at(turning + before);
    EXPECT_LT((there.p_map - back.p_map).norm(), 1e-12);
    EXPECT_LT((there.R_map_body - back.R_map_body).norm(), 1e-12);
    EXPECT_LT((there.v_map + back.v_map).norm(), 1e-12);
    EXPECT_LT((there.a_map - back.a_map).norm(), 1e-12);
  }
  EXPECT_NEAR(motion->travelled(turning), 14.0, 1e-12);
  EXPECT_NEAR(motion->travelled(motion->duration()), 1.0, 1e-12);
}

TEST(Paths, RefusalsNameTheEntry) {
  const std::vector<DriveStep> drive{{.duration = 10}};
  const MotionStart moving{.speed = 1.0};
  EXPECT_EQ(refusedPath({.start = moving, .path = {}, .drive = drive}), "path");
  EXPECT_EQ(refusedPath({.start = moving, .path = {{}}, .drive = drive}), "path[0]");
  EXPECT_EQ(refusedPath({.start = moving, .path = {{.radius = 3.0}}, .drive = drive}), "path[0].radius");
  EXPECT_EQ(refusedPath({.start = moving, .path = {{.length = 9.0}}, .drive = drive}), "drive");
  EXPECT_EQ(refusedPath({.start = {.speed = -1.0}, .path = {{.length = 9.0}}, .drive = drive}), "drive");
  EXPECT_EQ(refusedPath({.start = moving, .path = {{.length = 50.0}}, .drive = {{}, {}}}), "drive[1]");
  EXPECT_EQ(refusedPath({.path = {{.length = 50.0}}, .drive = {{}}}), "drive[0].until");  // at rest
}

TEST(Routes, PassThroughTheirEndsAndKeepToTheirGrades) {
  const RouteMotionConfig config = papers::shift();
  const RoutedPath path = routed(config.route);
  const auto motion = makeMotion(PathMotionConfig{
      .start = path.start, .path = path.path, .drive = {{.duration = 10, .speed_to = 5}, {}}});
  const Kinematics end = motion->at(motion->duration());
  EXPECT_NEAR(end.p_map.x(), 2800.0, 1e-8);
  EXPECT_NEAR(end.p_map.y(), 3000.0, 1e-8);
  EXPECT_NEAR(path.length, motion->travelled(motion->duration()), 1e-9);
  // On the incline between the vertical arcs: 8 degrees down, the floor at its profile's height.
  for (double t = 0.0; t < motion->duration(); t += 1.0) {
    const Kinematics body = motion->at(t);
    if (body.p_map.x() != 150.0 || body.p_map.y() < 200.0 || body.p_map.y() > 600.0) continue;
    EXPECT_NEAR(body.R_map_body(2, 0), -std::sin(std::atan(70.27 / 500.0)), 1e-12);
  }
}

TEST(Routes, HeightFollowsTheProfileThroughBendsAndArcs) {
  const Route route{.plan = {{0, 0}, {100, 0, 20}, {100, 100}},
                    .profile = {{0, 3}, {40, 3, 50}, {60, 5, 30}, {400, -29}},
                    .transition = 0.3};
  const RoutedPath path = routed(route);
  const auto motion = makeMotion(
      PathMotionConfig{.start = {.p_map = path.start.p_map, .speed = 1.0}, .path = path.path, .drive = {{}}});
  EXPECT_NEAR(motion->at(0.0).p_map.z(), 3.0, 1e-12);
  // From 70 m of chainage on the floor falls by a tenth of the way seen from above, also in the bend.
  double chainage = 0.0;
  constexpr double kDt = 0.01;
  for (double t = 0.0; t + kDt < motion->duration(); t += kDt) {
    chainage += kDt * motion->at(t + 0.5 * kDt).v_map.head<2>().norm();
    if (chainage < 70.0) continue;
    EXPECT_NEAR(motion->at(t + kDt).p_map.z(), 5.0 - 0.1 * (chainage - 60.0), 1e-5);
  }
  EXPECT_LT(path.length, 200.5);
}

TEST(Routes, RefusalsSayWhatIsTooTight) {
  EXPECT_EQ(refusedRoute({.plan = {{0, 0}}}), "route.plan");
  EXPECT_EQ(refusedRoute({.plan = {{0, 0}, {10, 0}, {10, 10}}}), "route.plan[1].radius");
  EXPECT_EQ(refusedRoute({.plan = {{0, 0}, {10, 0, 12}, {10, 30}}}), "route.plan[0]");
  EXPECT_EQ(refusedRoute({.plan = {{0, 0}, {10, 0, 1}, {0, 0}}}), "route.plan[1]");
  EXPECT_EQ(refusedRoute({.plan = {{0, 0}, {10, 0}}, .transition = 0.6}), "route.transition");
  EXPECT_EQ(refusedRoute({.plan = {{0, 0}, {10, 0}}, .profile = {{1, 0}}}), "route.profile[0].chainage");
  EXPECT_EQ(refusedRoute({.plan = {{0, 0}, {10, 0}}, .profile = {{0, 0}, {0, 1}}}),
            "route.profile[1].chainage");
  EXPECT_EQ(refusedRoute({.plan = {{0, 0}, {90, 0}}, .profile = {{0, 0}, {20, 0}, {90, 9}}}),
            "route.profile[1].radius");
  EXPECT_EQ(
      refusedRoute({.plan = {{0, 0}, {220, 0}}, .profile = {{0, 0}, {60, 0, 100}, {80, 9, 100}, {200, 9}}}),
      "route.profile[2]");
  EXPECT_EQ(
      refusedRoute({.plan = {{0, 0}, {50, 0, 20}, {50, 50}}, .profile = {{0, 0}, {40, 0, 50}, {90, 9}}}),
      "route.profile");
}

}  // namespace pos::sim
