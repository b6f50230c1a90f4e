#pragma once
/// Central differences over a manifold state, the oracle for every F and H.

#include <functional>
#include <type_traits>

#include "pos/core/manifold.hpp"

namespace pos::testing {

/// d f / d tangent of x, where f returns a vector (rows x n). `step` in the tangent's own units.
template <class X>
Eigen::MatrixXd numericJacobian(const X& x, int dof,
                                const std::type_identity_t<std::function<Eigen::VectorXd(const X&)>>& f,
                                double step = 1e-6) {
  Eigen::MatrixXd jacobian;
  for (int column = 0; column < dof; ++column) {
    Tangent<X> d = Tangent<X>::Zero(dof);
    d[column] = step;
    const Eigen::VectorXd ahead = f(plus(x, d));
    const Eigen::VectorXd behind = f(plus(x, Tangent<X>(-d)));
    if (column == 0) jacobian.resize(ahead.size(), dof);
    jacobian.col(column) = (ahead - behind) / (2.0 * step);
  }
  return jacobian;
}

}  // namespace pos::testing
