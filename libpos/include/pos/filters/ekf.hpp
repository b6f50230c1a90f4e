#pragma once
/// The extended Kalman filter on a manifold state. An error-state filter is the same kernel: the state
/// carries the nominal values, `plus` injects the error, and the error's mean is zero after every correction.
///
/// x = state    P = covariance of its tangent    F = d next / d x    Qd = process noise of the step
/// nu = innovation (reading minus prediction)    H = d prediction / d x    R = measurement noise
/// S = H P H' + R    K = P H' S^-1

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "pos/core/belief.hpp"
#include "pos/core/verdict.hpp"

namespace pos::filters {

/// What a motion model returns for one step.
template <Manifold X>
struct Step {
  X next;
  TangentMatrix<X> F;
  TangentMatrix<X> Qd;
};

/// What a sensor model returns for one reading of M numbers.
template <Manifold X, int M>
struct Innovation {
  Vector<M> nu;
  TangentRows<X, M> H;
};

/// A model of motion: step(state, input, dt) with dt in seconds.
template <class Model, class X, class Input>
concept MotionModel = requires(const Model& model, const X& x, const Input& u, double dt) {
  { model.step(x, u, dt) } -> std::same_as<Step<X>>;
};

/// A gate on the normalised innovation squared; open by default.
struct Gate {
  double threshold = std::numeric_limits<double>::infinity();
};

/// The whole story of one correction. S is the covariance that the gate and the gain used.
template <int M>
struct Correction {
  Verdict verdict = Verdict::Applied;
  Vector<M> nu = Vector<M>::Zero();
  Matrix<M, M> S = Matrix<M, M>::Zero();
  double nis = 0.0;
  static constexpr int kDof = M;
};

/// (P + P') / 2: the one place where symmetry is restored.
template <class Derived>
void symmetrise(Eigen::MatrixBase<Derived>& P) {
  P = (0.5 * (P + P.transpose())).eval();
}

/// Carries the belief through one step of motion: x <- f(x), P <- F P F' + Qd.
template <Manifold X>
void predict(Belief<X>& belief, const Step<X>& step) {
  belief.mean = step.next;
  belief.covariance = (step.F * belief.covariance * step.F.transpose() + step.Qd).eval();
  symmetrise(belief.covariance);
}

template <Manifold X, class Input>
void predict(Belief<X>& belief, const MotionModel<X, Input> auto& model, const Input& input, double dt) {
  predict(belief, model.step(belief.mean, input, dt));
}

namespace detail {
/// K = G S^-1. For one number that is a division: a general solver costs more than all the rest
/// (bench/range_odometry).
template <class Gain, class Factor>
Gain gain(const Gain& G, const Factor& S_factor) {
  if constexpr (Gain::ColsAtCompileTime == 1) {
    const double root = S_factor.matrixLLT()(0, 0);
    return G / (root * root);
  } else {
    return S_factor.solve(G.transpose()).transpose();
  }
}
}  // namespace detail

/// nu' S^-1 nu of a reading, without taking it.
template <Manifold X, int M>
double normalisedSquare(const Belief<X>& belief, const Innovation<X, M>& innovation, const Matrix<M, M>& R) {
  const Matrix<M, M> S = innovation.H * belief.covariance * innovation.H.transpose() + R;
  return innovation.nu.dot(S.llt().solve(innovation.nu));
}

/// Corrects the belief by one reading. The belief is untouched unless the verdict is Applied: Gated when
/// nu' S^-1 nu exceeds the gate, Degenerate when S is not positive definite or a number is not finite.
/// Covariance in Joseph's form, P <- (I - K H) P (I - K H)' + K R K', written out so that it costs O(M n^2):
/// with G = P H' it equals P - K G' - G K' + K S K' for any gain K.
template <Manifold X, int M>
Correction<M> correct(Belief<X>& belief, const Innovation<X, M>& innovation, const Matrix<M, M>& R,
                      Gate gate = {}) {
  using Gain = Eigen::Matrix<double, X::kDof, M, 0, pos::detail::maxDof<X>(), M>;
  const Gain G = belief.covariance * innovation.H.transpose();
  Correction<M> result;
  result.nu = innovation.nu;
  result.S = innovation.H * G + R;
  const Eigen::LLT<Matrix<M, M>> S_factor(result.S);
  if (S_factor.info() != Eigen::Success || !result.S.allFinite() || !result.nu.allFinite()) {
    result.verdict = Verdict::Degenerate;
    return result;
  }
  result.nis = result.nu.dot(S_factor.solve(result.nu));
  if (result.nis > gate.threshold) {
    result.verdict = Verdict::Gated;
    return result;
  }
  const Gain K = detail::gain(G, S_factor);
  belief.mean = plus(belief.mean, Tangent<X>(K * result.nu));
  const Gain rest = K * result.S - G;  // K S K' - K G' = K rest'
  belief.covariance.noalias() += K * rest.transpose();
  belief.covariance.noalias() -= G * K.transpose();
  symmetrise(belief.covariance);
  return result;
}

}  // namespace pos::filters
