#pragma once
/// The shapes in which a quantity goes from 0 to 1 while u goes from 0 to 1.

#include "pos/sim/motion_plan.hpp"

namespace pos::sim {

struct BlendPoint {
  double integral = 0.0;  ///< of value from 0 to u; 1/2 at u = 1 for every shape
  double value = 0.0;
  double rate = 0.0;  ///< d value / du
  double bend = 0.0;  ///< d rate / du
};

/// `ramp` is the Trapezoid's share of u on which the rate grows, 0..1/2. Outside [0, 1] the formula goes on.
BlendPoint blendAt(Blend blend, double ramp, double u);

/// The largest rate: 1, 1 / (1 - ramp), pi / 2, 15 / 8.
double peakRate(Blend blend, double ramp);

}  // namespace pos::sim
