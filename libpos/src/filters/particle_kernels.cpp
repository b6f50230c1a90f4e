#include "particle_kernels.hpp"

namespace pos::filters::kernel {

const ParticleKernels& particleKernels(InstructionSet set) {
  switch (set) {
    case InstructionSet::Avx2:
      return kAvx2;
    case InstructionSet::Avx512:
      return kAvx512;
    case InstructionSet::Portable:
      break;
  }
  return kPortable;
}

}  // namespace pos::filters::kernel
