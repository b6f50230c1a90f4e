#pragma once
/// Powers, logarithms, sines and Philox words on vectors of floats (core/lanes.hpp), for kernel sources only.
/// No branches, no tables. The error bounds are tested in tests/unit/filters/lanes_math_test.cpp.

#include "pos/core/lanes.hpp"

namespace pos::lanes {
inline namespace POS_LANES {

/// 1.5 * 2^23: adding and subtracting it rounds to a whole number, and the sum's lowest bits are that number.
inline constexpr float kRounder = 12582912.0F;

/// 2^t for t <= 126, relative error below 5e-7 + 6e-8 |t|; below t = -100 it stays at 2^-100 = 8e-31, far
/// enough from the numbers below 1e-38 that cost ten times as much.
POS_LANE_FUNCTION Floats power2(Floats t) {
  t = larger(t, all(-100.0F));
  const Floats shifted = t + kRounder;
  const Floats f =
      t - (shifted - kRounder);  // within +-1/2; the polynomial interpolates at Chebyshev's nodes
  const Floats f2 = f * f;
  const Floats p = (1.0F + f * 0.693147182F) +
                   f2 * ((0.240223497F + f * 0.0555038117F) + f2 * (0.00966636837F + f * 0.00133813021F));
  return floatsOf(bits(p) + (bits(shifted) << 23));
}

/// log2 x for normal x > 0, absolute error below 4e-7 (1 + |log2 x|).
POS_LANE_FUNCTION Floats logarithm2(Floats x) {
  const Ints exponent = __builtin_bit_cast(Ints, bits(x) - 0x3f3504f3U) >> 23;
  const Floats m = floatsOf(bits(x) - (__builtin_bit_cast(Words, exponent) << 23));  // sqrt(1/2) .. sqrt(2)
  const Floats t = (m - 1.0F) / (m + 1.0F);                                          // ln m = 2 atanh t
  const Floats t2 = t * t;
  const Floats series =
      2.88539008F + t2 * (0.961796694F + t2 * (0.577078016F + t2 * (0.412198583F + t2 * 0.320598898F)));
  return t * series + rounded(exponent);
}

struct SineCosine {
  Floats sine;
  Floats cosine;
};

/// Polynomials for |r| <= pi/4, absolute error below 2e-7.
POS_LANE_FUNCTION SineCosine smallSineCosine(Floats r) {
  const Floats r2 = r * r;
  return {r + r * r2 * (-1.66666655e-1F + r2 * (8.33216087e-3F - r2 * 1.95152959e-4F)),
          1.0F - 0.5F * r2 + r2 * r2 * (4.16666456e-2F + r2 * (-1.38873163e-3F + r2 * 2.44331571e-5F))};
}

/// Sine and cosine of an angle within +-100 rad, absolute error below 1e-6.
POS_LANE_FUNCTION SineCosine sineCosine(Floats angle) {
  const Floats shifted = angle * 0.636619772F + kRounder;
  const Floats n = shifted - kRounder;
  const Floats r =
      ((angle - n * 1.5703125F) - n * 4.83751297e-4F) - n * 7.54978995e-8F;  // pi/2 in three parts
  const SineCosine small = smallSineCosine(r);
  const Words quarter = bits(shifted);
  const Words odd = 0U - (quarter & 1U);  // all ones where sine and cosine change places
  const Words s = bits(small.sine);
  const Words c = bits(small.cosine);
  return {floatsOf(chosen(odd, c, s) ^ ((quarter & 2U) << 30)),
          floatsOf(chosen(odd, s, c) ^ (((quarter + 1U) & 2U) << 30))};
}

/// Unit vector of a direction that is uniform when the words are: two bits choose the quarter, thirty the
/// place in it.
POS_LANE_FUNCTION SineCosine direction(Words words) {
  constexpr float kScale = 3.65726688e-10F;  // pi/4 / 2^31
  const SineCosine small = smallSineCosine(rounded(__builtin_bit_cast(Ints, words << 2)) * kScale);
  const Words other = __builtin_bit_cast(Words, __builtin_bit_cast(Ints, words) >> 31);
  const Words s = bits(small.sine);
  const Words c = bits(small.cosine) ^ ((words << 1) & 0x80000000U);
  return {floatsOf(chosen(other, c, s)), floatsOf(chosen(other, s, c))};
}

/// Angle of at most a few turns brought into [-pi, pi].
POS_LANE_FUNCTION Floats wrapped(Floats angle) {
  const Floats turns = (angle * 0.159154943F + kRounder) - kRounder;
  return (angle - turns * 6.28125F) - turns * 1.93530717e-3F;  // 2 pi in two parts
}

/// Philox4x32-10 of core/random.hpp, one counter a lane: (counter, words 1 to 3 the same in every lane).
struct Philox {
  std::uint32_t key[2];
  std::uint32_t tail[3];
};
struct FourWords {
  Words of[4];
};

namespace philox {

/// Four words of every second lane, in the lower halves of 64-bit lanes; the upper halves hold anything.
struct Halves {
  LongWords w[4];
};

POS_LANE_FUNCTION Halves tenRounds(Halves h, const Philox& stream) {
  const LongWords m0 = LongWords{} + 0xD2511F53U;
  const LongWords m1 = LongWords{} + 0xCD9E8D57U;
  std::uint32_t key0 = stream.key[0];
  std::uint32_t key1 = stream.key[1];
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC unroll 10
#endif
  for (int round = 0; round < 10; ++round) {
    const LongWords product0 = halfProduct(h.w[0], m0);
    const LongWords product1 = halfProduct(h.w[2], m1);
    h = {{(product1 >> 32) ^ h.w[1] ^ key0, product1, (product0 >> 32) ^ h.w[3] ^ key1, product0}};
    key0 += 0x9E3779B9U;
    key1 += 0xBB67AE85U;
  }
  return h;
}

}  // namespace philox

POS_LANE_FUNCTION FourWords randomWords(Words counter, const Philox& stream) {
  const LongWords pairs = __builtin_bit_cast(LongWords, counter);
  const LongWords one = LongWords{} + stream.tail[0];
  const LongWords two = LongWords{} + stream.tail[1];
  const LongWords three = LongWords{} + stream.tail[2];
  const philox::Halves even = philox::tenRounds({{pairs, one, two, three}}, stream);
  const philox::Halves odd = philox::tenRounds({{pairs >> 32, one, two, three}}, stream);
  FourWords words;
  for (int k = 0; k < 4; ++k) {
    words.of[k] = __builtin_bit_cast(Words, (even.w[k] & 0xffffffffU) | (odd.w[k] << 32));
  }
  return words;
}

/// Two independent standard normals a lane from two words (Box-Muller); never beyond 5.9.
struct NormalPair {
  Floats first;
  Floats second;
};
POS_LANE_FUNCTION NormalPair normalPair(Words a, Words b) {
  const Floats u = (rounded(__builtin_bit_cast(Ints, a >> 8)) + 0.5F) * 0x1p-24F;  // in (0, 1)
  const Floats radius = root(logarithm2(u) * -1.38629436F);                        // -2 ln u
  const SineCosine way = direction(b);
  return {radius * way.cosine, radius * way.sine};
}

}  // namespace POS_LANES
}  // namespace pos::lanes
