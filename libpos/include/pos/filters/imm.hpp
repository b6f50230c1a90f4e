#pragma once
/// Interacting multiple models on a manifold (Blom and Bar-Shalom 1988; seamless paper, section 2.2): N
/// filters on the same state that see different sensors or move by different models.
///
/// Pi = transition, Pi(i, j) = P(j now | i before)    mu = mode probabilities    c = Pi' mu
/// mu_{i|j} = Pi(i, j) mu_i / c_j    lnL = log likelihoods    Gamma_i = d minus(x_i (+) d, x_0) / dd at zero
///
/// Probabilities stay in logarithms until they are normalised, so that no likelihood is too small for them.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pos/core/belief.hpp"

namespace pos::filters {

template <Manifold X, int N>
using Modes = std::array<Belief<X>, static_cast<std::size_t>(N)>;

/// c: the probabilities one step later, before anything is measured.
template <int N>
Vector<N> predictedModes(const Matrix<N, N>& Pi, const Vector<N>& mu) {
  return Pi.transpose() * mu;
}

/// Column j holds mu_{i|j}: what of filter j's past is filter i's. A mode that nothing leads to keeps its
/// own.
template <int N>
Matrix<N, N> mixingWeights(const Matrix<N, N>& Pi, const Vector<N>& mu) {
  const Vector<N> c = predictedModes<N>(Pi, mu);
  Matrix<N, N> weights;
  for (int j = 0; j < N; ++j) {
    if (c[j] > 0.0) {
      weights.col(j) = (Pi.col(j).array() * mu.array() / c[j]).matrix();
    } else {
      weights.col(j) = Vector<N>::Unit(j);
    }
  }
  return weights;
}

namespace detail {
/// States that know Gamma in closed form say so by a function `transported(x, e, P)` beside them: P carried
/// to the place from which `x` lies at `e`.
template <class X>
concept KnowsTransport = requires(const X& x, const Tangent<X>& e, const TangentMatrix<X>& P) {
  { transported(x, e, P) } -> std::convertible_to<TangentMatrix<X>>;
};
}  // namespace detail

/// Gamma P Gamma' by central differences: right for every manifold state, and slow. The oracle of tests where
/// a state has a closed form of its own.
template <Manifold X>
TangentMatrix<X> transportedNumerically(const X& x, const X& x_0, const TangentMatrix<X>& P) {
  constexpr double kStep = 1e-6;
  TangentMatrix<X> Gamma = P;
  for (Eigen::Index k = 0; k < P.cols(); ++k) {
    Tangent<X> d = Tangent<X>::Zero(P.rows());
    d[k] = kStep;
    Gamma.col(k) = (minus(plus(x, d), x_0) - minus(plus(x, Tangent<X>(-d)), x_0)) / (2.0 * kStep);
  }
  return Gamma * P * Gamma.transpose();
}

namespace detail {
template <Manifold X>
TangentMatrix<X> carried(const X& x, const X& x_0, const Tangent<X>& e, const TangentMatrix<X>& P) {
  if constexpr (KnowsTransport<X>) {
    return transported(x, e, P);
  } else {
    return transportedNumerically(x, x_0, P);
  }
}
}  // namespace detail

/// The Gaussian with mean and covariance of the mixture sum w_i N(x_i, P_i): the mean iterated on the
/// manifold from `x_0`, every P_i carried to its tangent. Weights sum to one; those of zero are skipped.
template <Manifold X, int N>
Belief<X> merged(const Modes<X, N>& modes, const Vector<N>& weights, X x_0) {
  constexpr int kIterations = 5;
  constexpr double kSettled = 1e-9;
  const auto at = [&](int i) -> const Belief<X>& { return modes[static_cast<std::size_t>(i)]; };
  for (int k = 0; k < kIterations; ++k) {
    Tangent<X> mean = Tangent<X>::Zero(at(0).covariance.rows());
    for (int i = 0; i < N; ++i) {
      if (weights[i] > 0.0) mean += weights[i] * minus(at(i).mean, x_0);
    }
    if (mean.norm() < kSettled) break;
    x_0 = plus(x_0, mean);
  }
  TangentMatrix<X> P = at(0).covariance;
  P.setZero();
  for (int i = 0; i < N; ++i) {
    if (weights[i] <= 0.0) continue;
    const Tangent<X> e = minus(at(i).mean, x_0);
    P += weights[i] * (detail::carried(at(i).mean, x_0, e, at(i).covariance) + e * e.transpose());
  }
  return {x_0, (0.5 * (P + P.transpose())).eval()};
}

/// Interaction: every filter starts the cycle from the mixture it would have come from.
template <Manifold X, int N>
Modes<X, N> mixed(const Modes<X, N>& modes, const Matrix<N, N>& weights) {
  Modes<X, N> next;
  for (int j = 0; j < N; ++j) {
    const auto own = static_cast<std::size_t>(j);
    const Vector<N> w = weights.col(j);
    next[own] = w[j] == 1.0 ? modes[own] : merged<X, N>(modes, w, modes[own].mean);
  }
  return next;
}

/// Combination, for output only: never given back to the filters.
template <Manifold X, int N>
Belief<X> combined(const Modes<X, N>& modes, const Vector<N>& mu) {
  Eigen::Index best = 0;
  mu.maxCoeff(&best);
  return merged<X, N>(modes, mu, modes[static_cast<std::size_t>(best)].mean);
}

/// How the likelihoods of modes with different sensors are compared.
enum class LikelihoodForm {
  Normalised,      ///< mean over the numbers measured, times three: as if each had measured a place in space
  Raw,             ///< densities as they are: units and counts differ, for study
  PositionDomain,  ///< of the place the readings amount to
};

/// What a mode's readings of a cycle say of it. d2 = nu' S^-1 nu, log_det_S = ln det S (metres).
struct Evidence {
  double d2 = 0.0;
  double log_det_S = 0.0;
  int dof = 0;
};

/// ln L. d2 is cut off at `d2_limit`, so that one wild reading cannot rule a mode out. PositionDomain expects
/// evidence of three numbers in that domain, where the other two forms are the same. dof > 0.
inline double logLikelihood(LikelihoodForm form, const Evidence& evidence,
                            double d2_limit = std::numeric_limits<double>::infinity()) {
  constexpr double kLog2Pi = 1.8378770664093453;
  const double n = evidence.dof;
  const double raw = -0.5 * (std::min(evidence.d2, d2_limit) + evidence.log_det_S + n * kLog2Pi);
  return form == LikelihoodForm::Normalised ? 3.0 / n * raw : raw;
}

/// mu_j proportional to c_j exp(lnL_j), any lnL from minus to plus infinity. Where nothing is left of any
/// mode: c.
template <int N>
Vector<N> bayes(const Vector<N>& c, const Vector<N>& lnL) {
  Vector<N> log_mu;
  for (int j = 0; j < N; ++j) {
    constexpr double kNever = -std::numeric_limits<double>::infinity();
    const double evidence = std::isnan(lnL[j]) ? kNever : std::clamp(lnL[j], kNever, 1e300);
    log_mu[j] = c[j] > 0.0 ? std::log(c[j]) + evidence : kNever;
  }
  const double top = log_mu.maxCoeff();
  if (!std::isfinite(top)) return c / c.sum();
  const Vector<N> mu = (log_mu.array() - top).exp().matrix();
  return mu / mu.sum();
}

/// No probability below `floor` (< 1 / N), their sum one.
template <int N>
Vector<N> floored(Vector<N> mu, double floor) {
  // What the floor takes is taken from the others in proportion to what they have above it.
  const Vector<N> above = (mu.array() - floor).max(0.0).matrix();
  const double sum = above.sum();
  if (!(sum > 0.0)) return Vector<N>::Constant(1.0 / N);
  return (floor + above.array() / sum * (1.0 - N * floor)).matrix();
}

}  // namespace pos::filters
