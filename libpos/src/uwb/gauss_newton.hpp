#pragma once
/// Weighted least squares on ranges for two or three unknowns: Gauss-Newton with Levenberg's damping when a
/// step does not help, then the search for bad ranges. Nothing allocates.
///
/// x = unknowns    e_i = range read - predicted    J_i = d predicted / d x    w_i = weight (1 / sigma^2)

#include <Eigen/Cholesky>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "pos/core/error.hpp"
#include "pos/core/manifold.hpp"
#include "pos/uwb/residual_test.hpp"

namespace pos::uwb::detail {

template <int N>
struct Linearised {
  double residual = 0.0;  ///< m
  Vector<N> row;          ///< d predicted / d x
};

using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRanges, 1>;

/// 1 / sigma^2 of every range.
template <class Range>
Weights weightsOf(std::span<const Range> ranges) {
  ensure(ranges.size() <= static_cast<std::size_t>(kMaxRanges), "too many ranges in one fit");
  Weights weights(static_cast<Eigen::Index>(ranges.size()));
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    weights[static_cast<Eigen::Index>(i)] = 1.0 / (ranges[i].sigma * ranges[i].sigma);
  }
  return weights;
}

/// What speaks against a fit of so many ranges: its residuals, and every range that it has to leave out.
template <class Fix>
double against(const Fix& fix, std::size_t ranges) {
  const auto left_out = static_cast<double>(ranges) - std::popcount(fix.used);
  return fix.chi_square + kRuledOut * left_out + (fix.consistent ? 0.0 : kRuledOut * kMaxRanges);
}

template <int N>
struct Normal {
  Matrix<N, N> information = Matrix<N, N>::Zero();
  Vector<N> gradient = Vector<N>::Zero();
  double cost = 0.0;
};

/// Model: `at(x)` gives a function object that linearises range i about x; `start(x, weights)` a start for
/// the ranges with a weight, without iterating, x where it has none.
template <int N, class Model>
Normal<N> normalEquations(const Model& model, const Vector<N>& x, const Weights& weights) {
  Normal<N> normal;
  const auto view = model.at(x);
  for (int i = 0; i < static_cast<int>(weights.size()); ++i) {
    if (weights[i] <= 0.0) continue;
    const Linearised<N> range = view(i);
    const Vector<N> weighted = weights[i] * range.row;
    normal.information.noalias() += weighted * range.row.transpose();
    normal.gradient += range.residual * weighted;
    normal.cost += weights[i] * range.residual * range.residual;
  }
  return normal;
}

template <int N>
struct Fit {
  Vector<N> x = Vector<N>::Zero();
  Normal<N> normal;
  bool solved = false;  ///< converged with an information matrix that can be inverted
};

inline constexpr int kIterations = 30;           // four to six from a good start
inline constexpr double kSmallDecrease = 1e-12;  // of the sum of squares; the step itself is still made

/// The minimum next to `x`.
template <int N, class Model>
Fit<N> fitted(const Model& model, Vector<N> x, const Weights& weights) {
  Fit<N> fit{x, normalEquations<N>(model, x, weights), false};
  double damping = 0.0;
  for (int k = 0; k < kIterations; ++k) {
    Matrix<N, N> A = fit.normal.information;
    A.diagonal() *= 1.0 + damping;
    const Eigen::LLT<Matrix<N, N>> factor(A);
    if (factor.info() != Eigen::Success) return fit;
    const Vector<N> step = factor.solve(fit.normal.gradient);
    if (!step.allFinite()) return fit;
    const Vector<N> tried = fit.x + step;
    const Normal<N> normal = normalEquations<N>(model, tried, weights);
    const bool small = step.dot(fit.normal.gradient) < kSmallDecrease * (1.0 + fit.normal.cost);
    if (normal.cost <= fit.normal.cost) {
      fit.x = tried;
      fit.normal = normal;
      damping = damping > 1e-6 ? 0.1 * damping : 0.0;
    } else {
      damping = std::max(10.0 * damping, 1e-3);
    }
    fit.solved = small;
    if (small) return fit;
  }
  return fit;
}

/// Inverse of the information; nothing when a direction is not measured at all.
template <int N>
bool invert(const Matrix<N, N>& information, Matrix<N, N>& covariance) {
  const Eigen::LLT<Matrix<N, N>> factor(information);
  if (factor.info() != Eigen::Success || factor.rcond() < 1e-12) return false;
  covariance = factor.solve(Matrix<N, N>::Identity());
  return covariance.allFinite();
}

template <int N>
struct RobustFit {
  Fit<N> fit;
  Weights weights;         ///< those of the final fit
  int used = 0;            ///< ranges with a weight
  bool consistent = true;  ///< the residual test passed, perhaps after leaving ranges out
  double inflation = 1.0;  ///< factor on the covariance where it did not
};

inline int counted(const Weights& weights) {
  return static_cast<int>((weights.array() > 0.0).count());
}

/// Leaves out the one range whose absence mends the fit, if there is one and a redundant one remains. Every
/// range is tried, from a start of its own: the fit with the bad range in it may lie in another valley.
template <int N, class Model>
bool leaveOneOut(const Model& model, const Vector<N>& start, const ResidualTest& test, const Weights& base,
                 RobustFit<N>& robust) {
  const int count = counted(base);
  if (count < N + 2) return false;
  RobustFit<N> best;
  best.fit.normal.cost = std::numeric_limits<double>::infinity();
  Weights weights = base;
  for (int i = 0; i < static_cast<int>(base.size()); ++i) {
    weights[i] = 0.0;
    const Fit<N> fit = fitted<N>(model, model.start(start, weights), weights);
    if (fit.solved && fit.normal.cost < best.fit.normal.cost) best = {fit, weights, count - 1, true, 1.0};
    weights[i] = base[i];
  }
  if (!test.passes(best.fit.normal.cost, count - 1 - N)) return false;
  robust = best;
  return true;
}

inline constexpr double kHuber = 1.345;  // 95 % efficient on Gaussian noise (Huber 1981)
inline constexpr int kReweightings = 12;

/// Huber's weights, the same for residuals of both signs, iterated from the plain fit; then every range that
/// stands out is left out, as long as a redundant one remains.
template <int N, class Model>
void reweighted(const Model& model, const ResidualTest& test, const Weights& base, RobustFit<N>& robust) {
  Fit<N> fit = robust.fit;
  Weights weights = base;
  for (int k = 0; k < kReweightings; ++k) {
    const auto view = model.at(fit.x);
    for (int i = 0; i < static_cast<int>(base.size()); ++i) {
      const double whitened = std::sqrt(base[i]) * std::abs(view(i).residual);
      weights[i] = base[i] * (whitened > kHuber ? kHuber / whitened : 1.0);
    }
    fit = fitted<N>(model, fit.x, weights);
    if (!fit.solved) return;
  }
  const auto view = model.at(fit.x);
  Weights kept = base;
  double chi_square = 0.0;
  for (int i = 0; i < static_cast<int>(base.size()); ++i) {
    const double squared = base[i] * view(i).residual * view(i).residual;
    chi_square += squared;
    if (squared > test.single()) kept[i] = 0.0;
  }
  if (counted(kept) > N) {
    const Fit<N> clean = fitted<N>(model, fit.x, kept);
    if (clean.solved && test.passes(clean.normal.cost, counted(kept) - N)) {
      robust = {clean, kept, counted(kept), true, 1.0};
      return;
    }
  }
  const int dof = std::max(1, counted(base) - N);
  robust = {fit, weights, counted(base), false, std::max(1.0, chi_square / dof)};
}

/// The plain fit where its residuals pass the test; otherwise without the one bad range; otherwise
/// reweighted.
template <int N, class Model>
RobustFit<N> robustFit(const Model& model, const Vector<N>& start, const Weights& weights,
                       const ResidualTest& test) {
  RobustFit<N> robust{fitted<N>(model, start, weights), weights, counted(weights), true, 1.0};
  if (robust.fit.solved && test.passes(robust.fit.normal.cost, robust.used - N)) return robust;
  if (leaveOneOut<N>(model, start, test, weights, robust)) return robust;
  if (robust.fit.solved) reweighted<N>(model, test, weights, robust);
  return robust;
}

inline std::uint32_t maskOf(const Weights& weights) {
  std::uint32_t mask = 0;
  for (int i = 0; i < static_cast<int>(weights.size()); ++i) {
    if (weights[i] > 0.0) mask |= std::uint32_t{1} << i;
  }
  return mask;
}

}  // namespace pos::uwb::detail
