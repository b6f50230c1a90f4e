#pragma once
/// The particle filter's loops as the equations say them, one particle after the other in double: the oracle
/// of the fast ones.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pos/core/angle.hpp"
#include "pos/core/random.hpp"
#include "pos/filters/particle_set.hpp"
#include "pos/filters/propagation.hpp"

namespace pos::filters::oracle {

/// Normal numbers of particle i at a step, from the words of Philox4x32-10 (docs/math/mcl.md, step 2).
inline Vector<3> noise(std::uint64_t seed, std::uint64_t step, std::size_t i) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  Vector<3> n;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t normal = 3 * (i % 64 / 16) + k;  // of the twelve that its place among sixteen gets
    const auto words =
        philox4x32({low(i / 64 * 48 + 16 * (normal / 4) + i % 16), low(step), low(step >> 32U), 0x6d6f7665U},
                   {low(seed), low(seed >> 32U)});
    const std::size_t pair = normal % 4 / 2;
    const double u = (static_cast<double>(words[2 * pair] >> 8U) + 0.5) * 0x1p-24;
    const std::uint32_t way = words[2 * pair + 1];
    const double r = static_cast<double>(static_cast<std::int32_t>(way << 2U)) * kPi / 4.0 * 0x1p-31;
    const double cosine = (way & 0x40000000U) != 0 ? -std::cos(r) : std::cos(r);
    const bool swapped = (way & 0x80000000U) != 0;
    const bool wants_cosine = normal % 2 == 0;
    const double part = wants_cosine != swapped ? cosine : std::sin(r);
    n[static_cast<Eigen::Index>(k)] = std::sqrt(-2.0 * std::log(u)) * part;
  }
  return n;
}

inline Pose2 moved(const Pose2& pose, const NoisyStep& motion, std::uint64_t seed, std::uint64_t step,
                   std::size_t i) {
  const Vector<3> d = Vector<3>(motion.displacement.x, motion.displacement.y, motion.displacement.yaw) +
                      motion.sigma.cwiseProduct(noise(seed, step, i));
  return pose * Pose2{d[0], d[1], d[2]};
}

/// Children of each parent: the teeth k with k + offset below the cumulative weight, in units of a tooth.
inline std::vector<std::size_t> childCounts(const std::vector<double>& weight, std::size_t count,
                                            double offset) {
  double total = 0.0;
  for (const double w : weight) total += w;
  std::vector<std::size_t> children;
  double cumulative = 0.0;
  std::size_t k = 0;
  for (const double w : weight) {
    cumulative += w / total * static_cast<double>(count);
    const std::size_t before = k;
    while (k < count && static_cast<double>(k) + offset < cumulative) ++k;
    children.push_back(k - before);
  }
  return children;
}

}  // namespace pos::filters::oracle
