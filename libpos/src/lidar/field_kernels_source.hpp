#pragma once
/// The loop of field_kernels.hpp, for the instruction set of the file that includes this.

#include "field_kernels.hpp"
#include "pos/core/lanes.hpp"

namespace pos::lidar::kernel {
namespace {

using namespace pos::lanes;

/// Table entries at these places.
POS_LANE_FUNCTION Floats lookedUp(const std::uint16_t* table, Words place) {
#if defined(__AVX512F__)
  const __m512i pairs = _mm512_i32gather_epi32(__builtin_bit_cast(__m512i, place), table, 2);
  return rounded(__builtin_bit_cast(Ints, __builtin_bit_cast(Words, pairs) & 0xffffU));
#elif defined(__AVX2__)
  const auto* pairs_at = reinterpret_cast<const int*>(table);
  const __m256i pairs = _mm256_i32gather_epi32(pairs_at, __builtin_bit_cast(__m256i, place), 2);
  return rounded(__builtin_bit_cast(Ints, __builtin_bit_cast(Words, pairs) & 0xffffU));
#else
  Ints values;
  for (std::size_t i = 0; i < kWidth; ++i) values[i] = table[place[i]];
  return rounded(values);
#endif
}

/// The smaller of two whole numbers, both taken without sign.
POS_LANE_FUNCTION Words atMost(Ints value, std::uint32_t most) {
#if defined(__AVX512F__)
  return __builtin_bit_cast(Words, _mm512_min_epu32(__builtin_bit_cast(__m512i, value),
                                                    __builtin_bit_cast(__m512i, allWords(most))));
#elif defined(__AVX2__)
  return __builtin_bit_cast(Words, _mm256_min_epu32(__builtin_bit_cast(__m256i, value),
                                                    __builtin_bit_cast(__m256i, allWords(most))));
#else
  const Words v = __builtin_bit_cast(Words, value);
  return chosen(__builtin_bit_cast(Words, v > most), allWords(most), v);
#endif
}

void addScores(const FieldView& field, const ScoreTask& task) {
  const auto stride = static_cast<std::uint32_t>(field.stride);
  for (std::size_t i = 0; i < task.poses; ++i) {
    const float c = task.cosine[i] * field.cells_per_metre;
    const float s = task.sine[i] * field.cells_per_metre;
    const float column0 = (task.x[i] - field.x_origin) * field.cells_per_metre;
    const float row0 = (task.y[i] - field.y_origin) * field.cells_per_metre;
    Sum sum;
    for (std::size_t b = 0; b < task.beams; b += kGroup) {
      for (std::size_t p = 0; p < kParts; ++p) {
        const Floats x = load(task.beam_x + b + kWidth * p);
        const Floats y = load(task.beam_y + b + kWidth * p);
        // What lies before the first cell is truncated to the frame or becomes huge without its sign, what
        // lies beyond the last is cut off: all of it ends in the table's frame of "outside" cells.
        const Words column = atMost(truncated(column0 + (c * x - s * y)), field.column_max);
        const Words row = atMost(truncated(row0 + (s * x + c * y)), field.row_max);
        sum.add(p, load(task.beam_weight + b + kWidth * p) * lookedUp(field.table, row * stride + column));
      }
    }
    task.total[i] += field.unit * static_cast<float>(sum.total());
  }
}

}  // namespace
}  // namespace pos::lidar::kernel
