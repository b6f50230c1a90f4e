#pragma once
/// POS_WIDE before a free function: compiled twice, for any x86-64 and for AVX2, chosen when the program
/// starts. Neither uses fused multiply-add, so both give the same bits.

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define POS_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define POS_WIDE
#endif

namespace pos {

/// Four neighbouring numbers, in one register where there is one; any address of a double will do.
using Four = double __attribute__((vector_size(32), aligned(8), may_alias));
inline Four& four(double* x) {
  return *reinterpret_cast<Four*>(x);
}
inline const Four& four(const double* x) {
  return *reinterpret_cast<const Four*>(x);
}

}  // namespace pos
