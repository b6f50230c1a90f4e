#pragma once
/// A Gaussian on a manifold: a mean and the covariance of its tangent.

#include "pos/core/manifold.hpp"

namespace pos {

template <Manifold X>
struct Belief {
  X mean{};
  TangentMatrix<X> covariance{};

  Belief() {
    if constexpr (X::kDof != Eigen::Dynamic) covariance.setZero();
  }
  Belief(const X& m, const TangentMatrix<X>& P) : mean(m), covariance(P) {}
};

}  // namespace pos
