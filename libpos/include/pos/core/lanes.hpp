#pragma once
/// Vectors of floats as wide as the instruction set that a file is compiled for. Only kernel sources include
/// this (`*_kernels_source.hpp`, each compiled once for every set of core/instruction_set.hpp).
///
/// Every operation is one IEEE operation on each lane: no fused multiply-add, no approximate reciprocals.
/// Sums go through `Sum`, which has sixteen lanes whatever the width. So a kernel gives the same bits with
/// every set.
///
/// A kernel source must not use inline functions of the standard library: the linker keeps one copy of each
/// for the whole program, and it might keep one that holds instructions the processor lacks.

#include <cstddef>
#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#if defined(__AVX512F__)
#define POS_LANES avx512
#elif defined(__AVX2__)
#define POS_LANES avx2
#else
#define POS_LANES portable
#endif
#define POS_LANE_FUNCTION [[gnu::always_inline]] inline

namespace pos::lanes {
inline namespace POS_LANES {

#if defined(__AVX512F__)
inline constexpr std::size_t kWidth = 16;
#elif defined(__AVX2__)
inline constexpr std::size_t kWidth = 8;
#else
inline constexpr std::size_t kWidth = 4;
#endif
/// Kernels take particles sixteen at a time, in kParts vectors.
inline constexpr std::size_t kGroup = 16;
inline constexpr std::size_t kParts = kGroup / kWidth;

using Floats = float __attribute__((vector_size(4 * kWidth)));
using Ints = std::int32_t __attribute__((vector_size(4 * kWidth)));
using Words = std::uint32_t __attribute__((vector_size(4 * kWidth)));
using LongWords = std::uint64_t __attribute__((vector_size(4 * kWidth)));

POS_LANE_FUNCTION Floats load(const float* from) {
  Floats values;  // a copy of bytes: clang takes a vector type for aligned, whatever its attributes say
  __builtin_memcpy(&values, from, sizeof(values));
  return values;
}
POS_LANE_FUNCTION void store(float* to, Floats values) {
  __builtin_memcpy(to, &values, sizeof(values));
}
POS_LANE_FUNCTION Floats all(float value) {
  return value - Floats{};
}
POS_LANE_FUNCTION Words allWords(std::uint32_t value) {
  return value + Words{};
}
POS_LANE_FUNCTION Words bits(Floats values) {
  return __builtin_bit_cast(Words, values);
}
POS_LANE_FUNCTION Floats floatsOf(Words values) {
  return __builtin_bit_cast(Floats, values);
}
POS_LANE_FUNCTION Floats rounded(Ints values) {
  return __builtin_convertvector(values, Floats);
}
POS_LANE_FUNCTION Ints truncated(Floats values) {
  return __builtin_convertvector(values, Ints);
}
/// `a` where the mask's bits are ones, else `b`.
POS_LANE_FUNCTION Words chosen(Words mask, Words a, Words b) {
  return b ^ ((a ^ b) & mask);
}

#if defined(__AVX512F__)
POS_LANE_FUNCTION Floats root(Floats x) {
  return _mm512_sqrt_ps(x);
}
POS_LANE_FUNCTION Floats larger(Floats a, Floats b) {
  return _mm512_max_ps(a, b);
}
POS_LANE_FUNCTION Floats smaller(Floats a, Floats b) {
  return _mm512_min_ps(a, b);
}
/// Products of the lower halves of the 64-bit lanes.
POS_LANE_FUNCTION LongWords halfProduct(LongWords a, LongWords b) {
  return __builtin_bit_cast(LongWords,
                            _mm512_mul_epu32(__builtin_bit_cast(__m512i, a), __builtin_bit_cast(__m512i, b)));
}
#elif defined(__AVX2__)
POS_LANE_FUNCTION Floats root(Floats x) {
  return _mm256_sqrt_ps(x);
}
POS_LANE_FUNCTION Floats larger(Floats a, Floats b) {
  return _mm256_max_ps(a, b);
}
POS_LANE_FUNCTION Floats smaller(Floats a, Floats b) {
  return _mm256_min_ps(a, b);
}
POS_LANE_FUNCTION LongWords halfProduct(LongWords a, LongWords b) {
  return __builtin_bit_cast(LongWords,
                            _mm256_mul_epu32(__builtin_bit_cast(__m256i, a), __builtin_bit_cast(__m256i, b)));
}
#elif defined(__x86_64__)
POS_LANE_FUNCTION Floats root(Floats x) {
  return _mm_sqrt_ps(x);
}
POS_LANE_FUNCTION Floats larger(Floats a, Floats b) {
  return _mm_max_ps(a, b);
}
POS_LANE_FUNCTION Floats smaller(Floats a, Floats b) {
  return _mm_min_ps(a, b);
}
POS_LANE_FUNCTION LongWords halfProduct(LongWords a, LongWords b) {
  return __builtin_bit_cast(LongWords,
                            _mm_mul_epu32(__builtin_bit_cast(__m128i, a), __builtin_bit_cast(__m128i, b)));
}
#else
POS_LANE_FUNCTION Floats root(Floats x) {
  for (std::size_t i = 0; i < kWidth; ++i) x[i] = __builtin_sqrtf(x[i]);
  return x;
}
POS_LANE_FUNCTION Floats larger(Floats a, Floats b) {
  for (std::size_t i = 0; i < kWidth; ++i) a[i] = a[i] > b[i] ? a[i] : b[i];
  return a;
}
POS_LANE_FUNCTION Floats smaller(Floats a, Floats b) {
  for (std::size_t i = 0; i < kWidth; ++i) a[i] = a[i] < b[i] ? a[i] : b[i];
  return a;
}
POS_LANE_FUNCTION LongWords halfProduct(LongWords a, LongWords b) {
  return (a & 0xffffffffU) * (b & 0xffffffffU);
}
#endif

/// Sixteen running sums in float, joined in double and in a fixed order. For some hundred values a lane.
struct Sum {
  Floats part[kParts] = {};

  POS_LANE_FUNCTION void add(std::size_t p, Floats values) { part[p] += values; }
  POS_LANE_FUNCTION double total() const {
    double sum = 0.0;
    for (std::size_t p = 0; p < kParts; ++p) {
      for (std::size_t i = 0; i < kWidth; ++i) sum += static_cast<double>(part[p][i]);
    }
    return sum;
  }
};

}  // namespace POS_LANES
}  // namespace pos::lanes
