#pragma once
/// Loops over particles, compiled once for every instruction set. Plain arrays at the border: these files
/// share no type with the rest of the library that could have another size there.

#include <cstddef>
#include <cstdint>

#include "pos/core/instruction_set.hpp"

namespace pos::filters::kernel {

/// Particles `first` .. `first + count`; the arrays begin at the set's first particle. `first` is a multiple
/// of 64.
struct Motion {
  float* x;
  float* y;
  float* yaw;
  float* cosine;  ///< of the new heading, out
  float* sine;
  std::size_t first, count;
  float step[3];   ///< m, m, rad
  float sigma[3];  ///< m, m, rad
  std::uint64_t seed, number;
};

struct WeightSums {
  double first, second;  ///< of w and of w^2, where nothing else is said
};

/// Particles seen from one of them.
struct CloudView {
  const float* x;
  const float* y;
  const float* yaw;
  const float* weight;
  std::size_t count;
  float x0, y0, yaw0;
};
struct DirectionSums {
  double weight, x, y, cosine, sine;
};
struct SpreadSums {
  double xx, xy, yy, xa, ya, aa;
};

/// Weights that take a log likelihood: w e^(l - top) with a power of it, as a power of two.
struct Weighing {
  const float* weight;
  float* value;  ///< in: log likelihood l. Out: the new weight
  std::size_t count;
  float top;
  float slope;  ///< exponent log2 e
};

struct ParticleKernels {
  void (*move)(const Motion&);
  void (*headings)(const float* yaw, float* cosine, float* sine, std::size_t count);
  WeightSums (*weightSums)(const float* weight, std::size_t count);
  void (*scale)(float* weight, std::size_t count, float factor);
  float (*largest)(const float* value, std::size_t count);
  WeightSums (*weigh)(const Weighing&);           ///< sums of the old and of the new weights
  DirectionSums (*directions)(const CloudView&);  ///< x0, y0 = where sums count from
  SpreadSums (*spread)(const CloudView&);         ///< x0, y0, yaw0 = the mean
};

extern const ParticleKernels kPortable;
extern const ParticleKernels kAvx2;
extern const ParticleKernels kAvx512;

const ParticleKernels& particleKernels(InstructionSet set);

}  // namespace pos::filters::kernel
