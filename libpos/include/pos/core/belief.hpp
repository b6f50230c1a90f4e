#pragma once
/// A Gaussian on a manifold: a mean and the covariance of its tangent.

#include "pos/core/manifold.hpp"

namespace pos {

template <FixedManifold X>
struct Belief {
  X mean{};
  Matrix<X::kDof, X::kDof> covariance = Matrix<X::kDof, X::kDof>::Zero();
};

}  // namespace pos
