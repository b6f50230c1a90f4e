#pragma once
/// Which vector instructions the processor has. The loops over many particles are compiled once for each of
/// these sets and chosen while the program runs; the decision record docs/decisions/0008 says how.

#include <string_view>
#include <vector>

namespace pos {

enum class InstructionSet {
  Portable,  ///< what every processor of the build's kind has; on x86-64 that is SSE2
  Avx2,
  Avx512,  ///< foundation with the DQ, BW and VL parts
};

std::string_view nameOf(InstructionSet set);

/// Those that this processor has, Portable first.
std::vector<InstructionSet> usableInstructionSets();

/// The widest of them; asked of the processor once.
InstructionSet bestInstructionSet();

}  // namespace pos
