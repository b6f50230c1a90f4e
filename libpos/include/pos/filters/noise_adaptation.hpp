#pragma once
/// Measurement noise learnt from the innovations, without any reference.
///
/// nu = innovation    S = H P H' + R, as the gate and the gain used it    R = measurement noise of that
/// update d = weight of the newest sample    b = forgetting factor, memory about 1 / (1 - b) samples

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "pos/core/manifold.hpp"

namespace pos::filters {

/// How one innovation speaks of R (Jiang et al. 2024, eq. 20, and its corrections).
enum class NoiseForm {
  Printed,   ///< nu nu': as printed; tends to S, not to R
  SageHusa,  ///< nu nu' - H P H': unbiased, but may lose positive definiteness
  Residual,  ///< eta eta' + H P+ H' with the residual eta after the update: positive by construction
};

/// What one accepted innovation says R is. With eta = R S^-1 nu and H P+ H' = R - R S^-1 R every form is a
/// function of nu, S and R alone; the residual form is R + R S^-1 (nu nu' - S) S^-1 R, whose fixed point is
/// the R for which S is the innovations' true covariance.
template <int M>
Matrix<M, M> noiseSample(NoiseForm form, const Vector<M>& nu, const Matrix<M, M>& S, const Matrix<M, M>& R) {
  const Matrix<M, M> outer = nu * nu.transpose();
  switch (form) {
    case NoiseForm::Printed:
      return outer;
    case NoiseForm::SageHusa:
      return outer - (S - R);
    case NoiseForm::Residual:
      break;
  }
  const Matrix<M, M> gain = S.ldlt().solve(R).transpose();  // R S^-1
  return R + gain * (outer - S) * gain.transpose();
}

/// `R` with its eigenvalues held in [low, high] (m^2, or the reading's unit squared).
template <int M>
Matrix<M, M> withEigenvaluesIn(const Matrix<M, M>& R, double low, double high) {
  const Eigen::SelfAdjointEigenSolver<Matrix<M, M>> eigen(0.5 * (R + R.transpose()));
  const Vector<M> held = eigen.eigenvalues().cwiseMax(low).cwiseMin(high);
  return eigen.eigenvectors() * held.asDiagonal() * eigen.eigenvectors().transpose();
}

struct NoiseAdaptationConfig {
  NoiseForm form = NoiseForm::Residual;
  double forgetting = 0.98;    ///< b, below 1
  int warm_up = 10;            ///< accepted samples before the first change
  double variance_min = 0.0;   ///< R never has a smaller eigenvalue
  double variance_max = 1e12;  ///< nor a larger one

  bool operator==(const NoiseAdaptationConfig&) const = default;
};

/// R on its way. Feed it accepted updates only, after the correction they belong to: an update's own gate and
/// gain must use the R from before. Never resets P.
template <int M>
class NoiseAdaptation {
 public:
  NoiseAdaptation(const NoiseAdaptationConfig& config, const Matrix<M, M>& start)
      : config_(config), R_(start) {}

  const Matrix<M, M>& R() const { return R_; }

  /// One accepted update: its innovation, its S, and the R in that S (which may hold more than `R()`, such as
  /// a map's survey error: only the difference between what came and what S foretold moves `R()`).
  void learn(const Vector<M>& nu, const Matrix<M, M>& S, const Matrix<M, M>& R_used) {
    fade_ *= config_.forgetting;
    if (++accepted_ <= config_.warm_up) return;
    // d_k = (1 - b) / (1 - b^(k + 1)), eq. 20. k counts the warm-up too: the start then weighs as much as the
    // samples it stood for, where counting from the first change would let one sample replace half of it.
    const double d = (1.0 - config_.forgetting) / (1.0 - fade_ * config_.forgetting);
    const Matrix<M, M> change = noiseSample(config_.form, nu, S, R_used) - R_used;
    R_ = withEigenvaluesIn<M>(R_ + d * change, config_.variance_min, config_.variance_max);
  }

 private:
  NoiseAdaptationConfig config_;
  Matrix<M, M> R_;
  int accepted_ = 0;
  double fade_ = 1.0;
};

}  // namespace pos::filters
