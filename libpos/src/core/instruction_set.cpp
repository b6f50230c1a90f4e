#include "pos/core/instruction_set.hpp"

namespace pos {

std::string_view nameOf(InstructionSet set) {
  switch (set) {
    case InstructionSet::Avx2:
      return "avx2";
    case InstructionSet::Avx512:
      return "avx512";
    case InstructionSet::Portable:
      break;
  }
  return "portable";
}

std::vector<InstructionSet> usableInstructionSets() {
  std::vector<InstructionSet> sets{InstructionSet::Portable};
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2")) sets.push_back(InstructionSet::Avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) {
    sets.push_back(InstructionSet::Avx512);
  }
#endif
  return sets;
}

InstructionSet bestInstructionSet() {
  static const InstructionSet kBest = usableInstructionSets().back();
  return kBest;
}

}  // namespace pos
