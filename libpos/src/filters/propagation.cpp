#include "pos/filters/propagation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pos/filters/fast_math.hpp"

namespace pos::filters {
namespace {

constexpr std::size_t kBlock = 256;
using Words = std::array<std::uint32_t, kBlock>;
using Floats = std::array<float, kBlock>;

struct RandomWords {
  std::array<Words, 4> word;
};
struct Normals {
  std::array<Floats, 3> of;
};

/// One round of Philox4x32 for a whole block, lane by lane (core/random.hpp has the scalar form).
void philoxRound(RandomWords& w, std::uint32_t key0, std::uint32_t key1) {
  for (std::size_t i = 0; i < kBlock; ++i) {
    const std::uint64_t product0 = std::uint64_t{0xD2511F53U} * w.word[0][i];
    const std::uint64_t product1 = std::uint64_t{0xCD9E8D57U} * w.word[2][i];
    w.word[0][i] = static_cast<std::uint32_t>(product1 >> 32U) ^ w.word[1][i] ^ key0;
    w.word[1][i] = static_cast<std::uint32_t>(product1);
    w.word[2][i] = static_cast<std::uint32_t>(product0 >> 32U) ^ w.word[3][i] ^ key1;
    w.word[3][i] = static_cast<std::uint32_t>(product0);
  }
}

/// Words of particles first .. first + kBlock - 1: Philox4x32-10 of counter (i, step, tag) under the seed.
void fillWords(RandomWords& w, std::uint64_t seed, std::uint64_t step, std::size_t first) {
  for (std::size_t i = 0; i < kBlock; ++i) w.word[0][i] = static_cast<std::uint32_t>(first + i);
  w.word[1].fill(static_cast<std::uint32_t>(step));
  w.word[2].fill(static_cast<std::uint32_t>(step >> 32U));
  w.word[3].fill(0x6d6f7665U);  // a stream of its own
  auto key0 = static_cast<std::uint32_t>(seed);
  auto key1 = static_cast<std::uint32_t>(seed >> 32U);
  for (int round = 0; round < 10; ++round) {
    philoxRound(w, key0, key1);
    key0 += 0x9E3779B9U;
    key1 += 0xBB67AE85U;
  }
}

/// In (0, 1), 24 bits.
float unit(std::uint32_t bits) {
  return (static_cast<float>(static_cast<std::int32_t>(bits >> 8U)) + 0.5F) * 0x1p-24F;
}

/// Box-Muller: two uniforms give two independent normals; the fourth of a particle is not needed.
void fillNormals(Normals& normals, const RandomWords& w) {
  constexpr float kTurn = 6.28318531F;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const float radius = std::sqrt(-2.0F * fastLog(unit(w.word[0][i])));
    const SineCosine direction = fastSineCosine(kTurn * unit(w.word[1][i]));
    normals.of[0][i] = radius * direction.cosine;
    normals.of[1][i] = radius * direction.sine;
    normals.of[2][i] =
        std::sqrt(-2.0F * fastLog(unit(w.word[2][i]))) * fastSineCosine(kTurn * unit(w.word[3][i])).cosine;
  }
}

}  // namespace

void propagate(ParticleSet& set, const NoisyStep& motion, std::uint64_t seed, std::uint64_t step) {
  const auto dx = static_cast<float>(motion.displacement.x);
  const auto dy = static_cast<float>(motion.displacement.y);
  const auto dyaw = static_cast<float>(motion.displacement.yaw);
  const Eigen::Vector3f sigma = motion.sigma.cast<float>();
  const float s0 = sigma[0];
  const float s1 = sigma[1];
  const float s2 = sigma[2];
  RandomWords words;
  Normals n;
  for (std::size_t first = 0; first < set.size(); first += kBlock) {
    fillWords(words, seed, step, first);
    fillNormals(n, words);
    const std::size_t count = std::min(kBlock, set.size() - first);
    float* x = set.x.data() + first;
    float* y = set.y.data() + first;
    float* yaw = set.yaw.data() + first;
    for (std::size_t i = 0; i < count; ++i) {
      const SineCosine heading = fastSineCosine(yaw[i]);
      const float along = dx + s0 * n.of[0][i];
      const float across = dy + s1 * n.of[1][i];
      x[i] += heading.cosine * along - heading.sine * across;
      y[i] += heading.sine * along + heading.cosine * across;
      yaw[i] = fastWrap(yaw[i] + dyaw + s2 * n.of[2][i]);
    }
  }
}

}  // namespace pos::filters
