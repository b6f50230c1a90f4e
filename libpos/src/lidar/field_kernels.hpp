#pragma once
/// The loop of likelihood_field.hpp over poses and beams, compiled once for every instruction set. Plain
/// arrays at the border.

#include <cstddef>
#include <cstdint>

#include "pos/core/instruction_set.hpp"

namespace pos::lidar::kernel {

struct FieldView {
  const std::uint16_t* table;  ///< one entry more than it needs: look-ups read 32 bits
  std::int32_t stride;
  std::uint32_t column_max, row_max;
  float x_origin, y_origin;  ///< m
  float cells_per_metre;
  float unit;  ///< value of a step of the table
};

/// Beams in an array that is filled up to a multiple of sixteen with beams of weight 0.
struct ScoreTask {
  const float* x;  ///< m, poses
  const float* y;
  const float* cosine;
  const float* sine;
  float* total;  ///< added to
  std::size_t poses;
  const float* beam_x;  ///< m, body
  const float* beam_y;
  const float* beam_weight;
  std::size_t beams;
};

struct FieldKernels {
  void (*addScores)(const FieldView&, const ScoreTask&);
};

extern const FieldKernels kPortable;
extern const FieldKernels kAvx2;
extern const FieldKernels kAvx512;

const FieldKernels& fieldKernels(InstructionSet set);

}  // namespace pos::lidar::kernel
