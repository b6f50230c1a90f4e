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

namespace detail {
template <class X>
constexpr int maxDof() {
  if constexpr (requires { X::kMaxDof; }) {
    return X::kMaxDof;
  } else {
    return X::kDof;
  }
}
}  // namespace detail

/// A tangent vector of X and a square matrix over it. X::kDof is the dimension, or Eigen::Dynamic with
/// X::kMaxDof as its bound; neither form allocates.
template <class X>
using Tangent = Eigen::Matrix<double, X::kDof, 1, 0, detail::maxDof<X>(), 1>;
template <class X>
using TangentMatrix = Eigen::Matrix<double, X::kDof, X::kDof, 0, detail::maxDof<X>(), detail::maxDof<X>()>;
/// An M-row matrix that acts on tangents of X (a measurement Jacobian).
template <class X, int M>
using TangentRows = Eigen::Matrix<double, M, X::kDof, (M == 1 ? Eigen::RowMajor : 0), M, detail::maxDof<X>()>;

template <class X>
concept Manifold = requires(const X& x, const Tangent<X>& d) {
  { X::kDof } -> std::convertible_to<int>;
  { plus(x, d) } -> std::same_as<X>;
  { minus(x, x) } -> std::convertible_to<Tangent<X>>;
};

}  // namespace pos
