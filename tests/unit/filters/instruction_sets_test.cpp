/// The particle loops give the same bits with every instruction set that this processor has, and with one
/// thread or several.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>

#include "pos/core/random.hpp"
#include "pos/filters/parallel.hpp"
#include "pos/filters/propagation.hpp"
#include "pos/filters/resampling.hpp"

namespace pos::filters {
namespace {

ParticleSet cloud(std::size_t count) {
  RandomStream random(3, 9);
  ParticleSet set;
  set.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.normal();
    const double y = random.normal();
    set.place(i, {x, y, random.uniform(-kPi, kPi)});
    set.weight[i] = static_cast<float>(std::exp(random.normal()));
  }
  return set;
}

const NoisyStep kMotion{{0.3, -0.1, 0.2}, {0.1, 0.05, 0.03}};

/// Everything the loops give, after a motion.
struct Outcome {
  ParticleSet set;
  HeadingTable headings;
  FloatArray weighed;
  double evidence = 0.0;
  Moments cloud;
};

Outcome outcome(std::size_t count, InstructionSet with) {
  Outcome all;
  all.set = cloud(count);
  propagate(all.set, all.headings, kMotion, 77, 5, with);
  all.weighed.assign(all.set.x.begin(), all.set.x.end());
  const Weighed weighed = weigh(all.set, all.weighed, 0.8, with);
  all.cloud = moments(all.set, with);
  all.evidence = weighed.log_evidence + weightSums(all.set, with).effectiveSize() + normalise(all.set, with);
  fillHeadings(all.headings, all.set, with);
  SystematicResampler().resample(all.set, count / 2 + 1, 0.7);
  return all;
}

void expectSame(const Outcome& a, const Outcome& b) {
  EXPECT_EQ(a.set.x, b.set.x);
  EXPECT_EQ(a.set.y, b.set.y);
  EXPECT_EQ(a.set.yaw, b.set.yaw);
  EXPECT_EQ(a.headings.cosine, b.headings.cosine);
  EXPECT_EQ(a.headings.sine, b.headings.sine);
  EXPECT_EQ(a.weighed, b.weighed);
  EXPECT_EQ(a.evidence, b.evidence);
  EXPECT_EQ(a.cloud.mean.x, b.cloud.mean.x);
  EXPECT_EQ(a.cloud.mean.yaw, b.cloud.mean.yaw);
  EXPECT_EQ(a.cloud.covariance, b.cloud.covariance);
}

}  // namespace

TEST(InstructionSets, GiveTheSameBits) {
  for (const std::size_t count : {1U, 15U, 64U, 5003U}) {
    const Outcome portable = outcome(count, InstructionSet::Portable);
    for (const InstructionSet with : usableInstructionSets()) {
      SCOPED_TRACE(std::string(nameOf(with)) + ", " + std::to_string(count) + " particles");
      expectSame(outcome(count, with), portable);
    }
  }
}

TEST(InstructionSets, BestIsOneOfTheUsable) {
  const auto usable = usableInstructionSets();
  EXPECT_EQ(usable.front(), InstructionSet::Portable);
  EXPECT_EQ(usable.back(), bestInstructionSet());
}

TEST(Threads, GiveTheSameBitsAsOne) {
  constexpr std::size_t kCount = 70 * kBlock + 99;  // more blocks than a thread takes at a time
  const auto with_threads = [&](int threads) {
    Outcome all;
    tbb::task_arena(threads).execute([&] { all = outcome(kCount, bestInstructionSet()); });
    return all;
  };
  expectSame(with_threads(4), with_threads(1));
}

TEST(Threads, EveryParticleIsInOneBlock) {
  std::vector<std::size_t> first(blockCount(40 * kBlock + 1), 1);
  std::vector<std::size_t> count(first.size(), 0);
  forBlocks(40 * kBlock + 1, Cost::Low, [&](const Block& block) {
    first[block.index] = block.first;
    count[block.index] += block.count;
  });
  for (std::size_t b = 0; b < first.size(); ++b) {
    EXPECT_EQ(first[b], b * kBlock);
    EXPECT_EQ(count[b], b + 1 < first.size() ? kBlock : 1U);
  }
}

}  // namespace pos::filters
