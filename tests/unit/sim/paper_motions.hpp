#pragma once
/// The papers' motions, as a scenario would write them.

#include "pos/core/angle.hpp"
#include "pos/sim/motion_plan.hpp"

namespace pos::sim::papers {

inline Segment wait(double duration) {
  return {.drive = {.duration = duration}};
}
inline Segment speedUp(double duration, double speed_to) {
  return {.drive = {.duration = duration, .speed_to = speed_to}};
}
inline Segment turn(double duration, double by) {
  return {.drive = {.duration = duration}, .turn = {.by = by}};
}
inline Segment climb(double duration, double by) {
  return {.drive = {.duration = duration}, .climb = {.by = by}};
}

/// Paper A, double lane shift.
inline SegmentMotionConfig laneShift() {
  constexpr double kRamp = 0.98626;
  return {.segments = {wait(5), speedUp(1, 1.0), wait(2), turn(2, -0.4), wait(2), turn(2, 0.4), wait(5),
                       turn(kRamp, 0.4), wait(5 - 2 * kRamp), turn(kRamp, -0.4), wait(6)}};
}

/// Paper A, quarter turn.
inline SegmentMotionConfig quarterTurn() {
  return {
      .segments = {wait(12), speedUp(1.14554, 0.3 * kPi), wait(8 - 1.14554), turn(5, -0.5 * kPi), wait(10)}};
}

/// P1, circle run.
inline SegmentMotionConfig circle() {
  return {.start = {.speed = 2.0}, .segments = {wait(10), turn(20 * kPi, 2 * kPi)}};
}

/// P1, surface to underground, 75 s.
inline SegmentMotionConfig incline() {
  return {.segments = {wait(10), speedUp(5, 10.0), wait(5), speedUp(10, 5.0), climb(20, radians(-8)),
                       climb(20, radians(8)), wait(5)}};
}

/// Paper B, curve A to B.
inline SegmentMotionConfig curve() {
  Segment left = turn(20, radians(110));
  Segment right = turn(10, radians(-37.2));
  for (Change* change : {&left.turn, &right.turn}) {
    change->blend = Blend::Trapezoid;
    change->ramp = 1.0;
  }
  return {.segments = {wait(5), speedUp(1, 0.2), left, right, speedUp(1, 0.0)}};
}

/// Paper B, loop with large turns.
inline SegmentMotionConfig loop() {
  Segment winding = turn(64, 2 * kPi);
  winding.turn.wave_amplitude = 0.5;
  winding.turn.wave_period = 8.0;
  return {.segments = {wait(5), speedUp(1, 0.4), winding, speedUp(1, 0.0), wait(4)}};
}

/// Paper B, slip: the body held by a rope from 7 to 13 s.
inline SegmentMotionConfig rope() {
  return {.segments = {wait(3.37), speedUp(0.6, 0.3), wait(3.03), speedUp(0.1, 0.0), wait(5.9),
                       speedUp(0.1, 0.3), wait(8.9), speedUp(0.6, 0.0), wait(2.4)}};
}

/// Paper B, roadway with a branch and a bend (the leg after the bend).
inline RouteMotionConfig branch() {
  return {.route = {.plan = {{0, 0}, {600, 0, 15}, {600, 300}}},
          .drive = {{.duration = 5}, {.duration = 6, .speed_to = 3.0}, {}, {.duration = 6, .speed_to = 0.0}}};
}

/// P1, mock inclined shaft: down a 4 m ramp at 15 degrees, around the loop and back up.
inline RouteMotionConfig mockShaft() {
  const double drop = 4.0 * std::tan(radians(15));
  return {
      .route = {.plan = {{0, 0}, {41.5, 0, 1.2}, {41.5, -7, 1.2}, {53.5, -7, 1.2}, {53.5, 0, 1.2}, {0, 0}},
                .profile = {{0, 0}, {17, 0, 1.0}, {21, -drop, 1.0}, {27, -drop}},
                .transition = 0.25},
      .drive = {{.duration = 10},
                {.duration = 10, .speed_to = 0.3, .speed_blend = Blend::Smooth},
                {},
                {.duration = 10, .speed_to = 0.0, .speed_blend = Blend::Smooth}}};
}

/// A shift in a mine of 6 km: yard, portal, incline of 8 degrees, main roadway, junctions, gateway, a stop at
/// a chamber and a shunt backwards.
inline RouteMotionConfig shift() {
  return {.route = {.plan = {{0, 0},
                             {150, 0, 30},
                             {150, 900, 40},
                             {2200, 900, 15},
                             {2200, 2400, 15},
                             {2800, 2400, 15},
                             {2800, 3000}},
                    .profile = {{0, 0}, {260, 0, 80}, {760, -70.27, 80}, {6000, -75}},
                    .transition = 0.2},
          .drive = {{.duration = 60},
                    {.duration = 8, .speed_to = 5.0, .speed_blend = Blend::Smooth},
                    {.until = 2000},
                    {.duration = 10, .speed_to = 0.0, .speed_blend = Blend::Cosine},
                    {.duration = 90},
                    {.duration = 5, .speed_to = -1.0},
                    {.duration = 20},
                    {.duration = 10, .speed_to = 4.0, .speed_blend = Blend::Smooth},
                    {},
                    {.duration = 8, .speed_to = 0.0},
                    {.duration = 60}}};
}

/// P2, the whole 7.1 h with bend, floor and creep.
inline ShearerConfig shearerRun() {
  return {.creep = {-0.176, -0.225, -0.175, -0.225, -0.175}, .bend_peak = 0.1, .floor_peak = 0.1};
}

}  // namespace pos::sim::papers
