#pragma once
/// The loop of range_likelihood.hpp, compiled once for every instruction set. Plain arrays at the border.

#include <cstddef>

#include "pos/core/instruction_set.hpp"

namespace pos::estimation::kernel {

/// Some particles and one range. The likelihood is taken relative to its peak:
/// L = inlier 2^(slope nu^2) + outlier, at most 1.
struct RangeBlock {
  const float* x;
  const float* y;
  const float* cosine;
  const float* sine;
  const float* weight;
  float* posterior;  ///< weight * L^power, out
  std::size_t count;
  float anchor_x, anchor_y, height2;  ///< m, m, m^2: from the set's origin, squared height above the tag
  float tag_x, tag_y;                 ///< m, on the body
  float range;                        ///< m
  float centre;                       ///< m, where sums of distances count from
  float slope;                        ///< 1/m^2
  float inlier, outlier;
  float power;
};

struct RangeBlockSums {
  double weight;      ///< of w
  double likelihood;  ///< of w L
  double distance;    ///< of w (d - centre)
  double distance2;   ///< of w (d - centre)^2
};

struct RangeKernels {
  RangeBlockSums (*whole)(const RangeBlock&);  ///< power 1
  RangeBlockSums (*power)(const RangeBlock&);
};

extern const RangeKernels kPortable;
extern const RangeKernels kAvx2;
extern const RangeKernels kAvx512;

const RangeKernels& rangeKernels(InstructionSet set);

}  // namespace pos::estimation::kernel
