#pragma once
/// Moving a particle set by a noisy body-frame displacement.

#include <cstdint>

#include "pos/filters/particle_set.hpp"

namespace pos::filters {

/// A displacement T_previous_now with the standard deviation of each part, in the previous body frame.
struct NoisyStep {
  Pose2 displacement;                   ///< m, m, rad; the turn within +-2 pi
  Vector<3> sigma = Vector<3>::Zero();  ///< m (along), m (across), rad
};

/// Move every particle by its own sample, pose_i <- pose_i * (displacement + sigma o n_i), n_i standard
/// normal, and fill in the new headings on the way. n_i is a pure function of (seed, step, i): Philox4x32-10
/// under the seed and Box-Muller, four normals a call, three a particle.
void propagate(ParticleSet& set, HeadingTable& headings, const NoisyStep& motion, std::uint64_t seed,
               std::uint64_t step, InstructionSet with = bestInstructionSet());

}  // namespace pos::filters
