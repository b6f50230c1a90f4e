#pragma once
/// States live on manifolds: `plus` moves along a tangent vector, `minus` gives the tangent between two
/// states.
///
/// Laws (tests/support/manifold_laws.hpp runs them over every state type):
///   plus(x, 0) = x      minus(x, x) = 0      plus(x, minus(y, x)) = y      minus(plus(x, d), x) = d for
///   small d

#include <Eigen/Core>
#include <concepts>

namespace pos {

template <int Rows, int Cols = 1>
using Matrix = Eigen::Matrix<double, Rows, Cols>;
template <int Rows>
using Vector = Eigen::Matrix<double, Rows, 1>;

/// Tangent dimension known when compiled.
template <class X>
concept FixedManifold = requires(const X& x, const Vector<X::kDof>& d) {
  { X::kDof } -> std::convertible_to<int>;
  { plus(x, d) } -> std::same_as<X>;
  { minus(x, x) } -> std::convertible_to<Vector<X::kDof>>;
};

}  // namespace pos
