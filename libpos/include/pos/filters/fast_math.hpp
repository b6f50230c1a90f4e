#pragma once
/// exp, log, sine and cosine in float without branches or tables, so that a plain loop over particles becomes
/// vector code. bench/mcl.cpp measures the loops built on them.

#include <algorithm>
#include <bit>
#include <cstdint>

namespace pos::filters {

/// e^x, relative error below 1e-6; below -87 it stays at e^-87 (about 1.6e-38), above 88 at e^88.
inline float fastExp(float x) {
  constexpr float kRounder = 12582912.0F;  // 1.5 * 2^23: adding and subtracting it rounds to a whole number
  const float clamped = std::min(std::max(x, -87.0F), 88.0F);
  const float shifted = clamped * 1.44269504F + kRounder;
  const float n = shifted - kRounder;
  const float r = (clamped - n * 0.693359375F) + n * 2.12194440e-4F;  // ln 2 in two parts
  const float r2 = r * r;  // Taylor series in pairs (Estrin): a shorter chain than Horner's
  const float p = (1.0F + r) + r2 * ((0.5F + r * (1.0F / 6.0F)) +
                                     r2 * ((1.0F / 24.0F + r * (1.0F / 120.0F)) + r2 * (1.0F / 720.0F)));
  const std::int32_t exponent = std::bit_cast<std::int32_t>(shifted) - std::bit_cast<std::int32_t>(kRounder);
  return p * std::bit_cast<float>((exponent + 127) << 23);
}

/// e^x of a log weight or log likelihood relative to the best one: below e^-40 (4e-18, nothing beside 1) it
/// stays there, so that a product of two is still a normal number. Numbers smaller than those cost ten times
/// as much.
inline float relativeWeight(float x) {
  return fastExp(std::max(x, -40.0F));
}

/// ln x for normal x > 0, absolute error below 3e-7 * (1 + |ln x|).
inline float fastLog(float x) {
  constexpr std::int32_t kSqrtHalf = 0x3f3504f3;
  const std::int32_t bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - kSqrtHalf) >> 23;
  const float m = std::bit_cast<float>(bits - (exponent << 23));  // in [sqrt(1/2), sqrt(2))
  const float t = (m - 1.0F) / (m + 1.0F);                        // ln m = 2 atanh t
  const float t2 = t * t;
  const float series = 2.0F + t2 * (0.666666667F + t2 * (0.4F + t2 * (0.285714286F + t2 * 0.222222222F)));
  return t * series + static_cast<float>(exponent) * 0.693147181F;
}

struct SineCosine {
  float sine;
  float cosine;
};

/// sin and cos of an angle within +-100 rad, absolute error below 1e-6 near +-pi.
inline SineCosine fastSineCosine(float angle) {
  constexpr float kRounder = 12582912.0F;
  const float shifted = angle * 0.636619772F + kRounder;
  const float n = shifted - kRounder;
  const float r =
      ((angle - n * 1.5703125F) - n * 4.83751297e-4F) - n * 7.54978995e-8F;  // pi/2 in three parts
  const float r2 = r * r;
  const float s = r + r * r2 * (-1.66666655e-1F + r2 * (8.33216087e-3F - r2 * 1.95152959e-4F));
  const float c =
      1.0F - 0.5F * r2 + r2 * r2 * (4.16666456e-2F + r2 * (-1.38873163e-3F + r2 * 2.44331571e-5F));
  const std::uint32_t quarter = std::bit_cast<std::uint32_t>(shifted);
  const std::uint32_t odd = 0U - (quarter & 1U);  // all ones where sine and cosine change places
  const std::uint32_t s_bits = std::bit_cast<std::uint32_t>(s);
  const std::uint32_t c_bits = std::bit_cast<std::uint32_t>(c);
  const std::uint32_t sine = (s_bits & ~odd) | (c_bits & odd);
  const std::uint32_t cosine = (c_bits & ~odd) | (s_bits & odd);
  return {std::bit_cast<float>(sine ^ ((quarter & 2U) << 30U)),
          std::bit_cast<float>(cosine ^ (((quarter + 1U) & 2U) << 30U))};
}

/// Angle of at most a few turns brought into [-pi, pi].
inline float fastWrap(float angle) {
  constexpr float kRounder = 12582912.0F;
  const float turns = (angle * 0.159154943F + kRounder) - kRounder;
  return (angle - turns * 6.28125F) - turns * 1.93530717e-3F;  // 2 pi in two parts
}

}  // namespace pos::filters
