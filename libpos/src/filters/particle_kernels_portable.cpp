#include "particle_kernels_source.hpp"

namespace pos::filters::kernel {

const ParticleKernels kPortable{move, headings, weightSums, scale, largest, weigh, directions, spread};

}  // namespace pos::filters::kernel
