#include "pos/ins/block_transition.hpp"

#include "pos/core/wide.hpp"

namespace pos::ins {

POS_WIDE void addTurned(double* __restrict__ m, const double* __restrict__ p, const double* __restrict__ A,
                        int rows) {
  for (int i = 0; i < rows; ++i) {
    const double a = p[i];
    const double b = p[rows + i];
    const double c = p[2 * rows + i];
    m[i] += A[0] * a + A[3] * b + A[6] * c;
    m[rows + i] += A[1] * a + A[4] * b + A[7] * c;
    m[2 * rows + i] += A[2] * a + A[5] * b + A[8] * c;
  }
}

}  // namespace pos::ins
