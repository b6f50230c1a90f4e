#include "pos/filters/propagation.hpp"

#include "particle_kernels.hpp"
#include "pos/filters/parallel.hpp"

namespace pos::filters {

void propagate(ParticleSet& set, HeadingTable& headings, const NoisyStep& motion, std::uint64_t seed,
               std::uint64_t step, InstructionSet with) {
  headings.cosine.resize(set.size());
  headings.sine.resize(set.size());
  const Eigen::Vector3f sigma = motion.sigma.cast<float>();
  const kernel::Motion whole{
      .x = set.x.data(),
      .y = set.y.data(),
      .yaw = set.yaw.data(),
      .cosine = headings.cosine.data(),
      .sine = headings.sine.data(),
      .first = 0,
      .count = 0,
      .step = {static_cast<float>(motion.displacement.x), static_cast<float>(motion.displacement.y),
               static_cast<float>(motion.displacement.yaw)},
      .sigma = {sigma[0], sigma[1], sigma[2]},
      .seed = seed,
      .number = step};
  const auto move = kernel::particleKernels(with).move;
  forBlocks(set.size(), Cost::Low, [&](const Block& block) {
    kernel::Motion part = whole;
    part.first = block.first;
    part.count = block.count;
    move(part);
  });
}

}  // namespace pos::filters
