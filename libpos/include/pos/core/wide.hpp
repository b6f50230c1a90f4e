#pragma once
/// POS_WIDE before a free function: compiled twice, for any x86-64 and for AVX2, chosen when the program
/// starts. Neither uses fused multiply-add, so both give the same bits.

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define POS_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define POS_WIDE
#endif

namespace pos {

#if defined(__GNUC__) && !defined(__clang__)
/// Four neighbouring numbers, in one register where there is one; any address of a double will do.
using Four = double __attribute__((vector_size(32), aligned(8), may_alias));
/// Numbers A to D of those of x, followed by those of y.
#define POS_PICKED(x, y, A, B, C, D) __builtin_shufflevector(x, y, A, B, C, D)
#else
/// The same one by one: clang takes a register's alignment for granted behind a reference.
struct __attribute__((may_alias)) Four {
  double of[4];

  double& operator[](int i) { return of[i]; }
  double operator[](int i) const { return of[i]; }
  Four& operator+=(const Four& o) { return *this = {of[0] + o[0], of[1] + o[1], of[2] + o[2], of[3] + o[3]}; }
  Four& operator-=(const Four& o) { return *this = {of[0] - o[0], of[1] - o[1], of[2] - o[2], of[3] - o[3]}; }
  friend Four operator+(Four a, const Four& b) { return a += b; }
  friend Four operator-(Four a, const Four& b) { return a -= b; }
  friend Four operator*(double s, const Four& a) { return {s * a[0], s * a[1], s * a[2], s * a[3]}; }
  friend Four operator*(const Four& a, double s) { return s * a; }
};
inline Four picked(const Four& x, const Four& y, int A, int B, int C, int D) {
  const auto one = [&](int i) { return i < 4 ? x[i] : y[i - 4]; };
  return {one(A), one(B), one(C), one(D)};
}
#define POS_PICKED(x, y, A, B, C, D) ::pos::picked(x, y, A, B, C, D)
#endif

inline Four& four(double* x) {
  return *reinterpret_cast<Four*>(x);
}
inline const Four& four(const double* x) {
  return *reinterpret_cast<const Four*>(x);
}

}  // namespace pos
