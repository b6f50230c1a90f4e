#pragma once
/// Moving a particle set by a noisy body-frame displacement.

#include <cstdint>
#include <span>

#include "pos/filters/particle_set.hpp"

namespace pos::filters {

/// A displacement T_previous_now with the standard deviation of each part, in the previous body frame.
struct NoisyStep {
  Pose2 displacement;                   ///< m, m, rad
  Vector<3> sigma = Vector<3>::Zero();  ///< m (along), m (across), rad
};

/// Move every particle by its own sample: pose_i <- pose_i * (displacement + sigma o n_i), n_i standard
/// normal. n_i is a pure function of (seed, step, i), so the result does not depend on how the loop is split.
void propagate(ParticleSet& set, const NoisyStep& motion, std::uint64_t seed, std::uint64_t step);

}  // namespace pos::filters
