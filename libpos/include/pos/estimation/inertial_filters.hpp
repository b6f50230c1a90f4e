#pragma once
/// Three filters over one inertial state, with one interface so that they see the same data with the same
/// noise: the error-state filter, the extended Kalman filter with the quaternion's four numbers as states,
/// and sigma points on the manifold (docs/math/eskf.md).
///
/// A sensor model is any callable that takes an EskfState and gives filters::Innovation<EskfState, M>.

#include "pos/estimation/range_offsets.hpp"

namespace pos::estimation {

/// Motion when the inertial unit is silent: straight on, and ever less sure.
ins::EskfTransition coasting(double dt);
Vector<15> coastingNoise(double dt);

/// The filter of ins/eskf, with offsets of anchors' ranges as further states while there are any.
class EskfFilter {
 public:
  EskfFilter(const Belief<EskfState>& start, const ins::EskfProcess& process, double spread = 1e-3);

  void propagate(const ins::ImuIncrement& raw);
  void coast(double dt);
  const EskfState& mean() const { return belief_.mean; }
  Belief<EskfState> belief() const { return belief_; }
  /// nu and H P H' of a range.
  SequentialCorrection::Expected expected(const RangeLink& link) const;
  filters::Correction<1> take(const RangeLink& link, double R);
  template <int M, class Model>
  filters::Correction<M> correct(const Model& model, const Matrix<M, M>& R, filters::Gate gate);
  /// Adds to the variances of the error.
  void inflate(const Vector<15>& variance) { belief_.covariance.diagonal() += variance; }

  /// Offsets of anchors' ranges; whoever watches the anchors adds and drops them.
  RangeOffsets& offsets() { return offsets_; }
  const RangeOffsets& offsets() const { return offsets_; }

 private:
  Belief<EskfState> belief_;
  ins::EskfProcess process_;
  RangeOffsets offsets_;
};

/// Total state, 16 numbers, additive quaternion (section A5.1 of the specification). Its covariance has rank
/// 15: after every correction the quaternion is normalised and the covariance projected.
class AdditiveEkf {
 public:
  AdditiveEkf(const Belief<EskfState>& start, const ins::EskfProcess& process, double spread = 1e-3);

  void propagate(const ins::ImuIncrement& raw);
  void coast(double dt);
  const EskfState& mean() const { return x_; }
  Belief<EskfState> belief() const;
  SequentialCorrection::Expected expected(const RangeLink& link) const;
  filters::Correction<1> take(const RangeLink& link, double R);
  template <int M, class Model>
  filters::Correction<M> correct(const Model& model, const Matrix<M, M>& R, filters::Gate gate);
  void inflate(const Vector<15>& variance);

  const Matrix<16, 16>& covariance16() const { return P_; }

 private:
  template <int M>
  filters::Correction<M> correctWith(const filters::Innovation<EskfState, M>& innovation,
                                     const Matrix<M, M>& R, filters::Gate gate);

  EskfState x_;
  Matrix<16, 16> P_;  // p v q(w x y z) a_b w_b
  ins::EskfProcess process_;
};

/// Unscented filter with the error's fifteen numbers (section A5.2).
class ManifoldUkf {
 public:
  ManifoldUkf(const Belief<EskfState>& start, const ins::EskfProcess& process, double spread);

  void propagate(const ins::ImuIncrement& raw);
  void coast(double dt);
  const EskfState& mean() const { return belief_.mean; }
  Belief<EskfState> belief() const { return belief_; }
  SequentialCorrection::Expected expected(const RangeLink& link) const;
  filters::Correction<1> take(const RangeLink& link, double R);
  template <int M, class Model>
  filters::Correction<M> correct(const Model& model, const Matrix<M, M>& R, filters::Gate gate);
  void inflate(const Vector<15>& variance) { belief_.covariance.diagonal() += variance; }

 private:
  struct Weights {
    double first_mean;
    double first_covariance;
    double other;
    double scale;  // of the square root of P
  };
  Matrix<15, 15> root() const;
  template <int M>
  struct Cloud {
    Vector<M> nu;         // mean innovation
    Matrix<M, M> spread;  // without the reading's noise
    Matrix<15, M> cross;  // of the error with the reading
  };
  template <int M, class Model>
  Cloud<M> seenThrough(const Model& model) const;
  template <int M>
  filters::Correction<M> correctWith(const Cloud<M>& cloud, const Matrix<M, M>& R, filters::Gate gate);

  Belief<EskfState> belief_;
  ins::EskfProcess process_;
  Weights weights_;
};

// ---------------------------------------------------------------- templates

template <int M, class Model>
filters::Correction<M> EskfFilter::correct(const Model& model, const Matrix<M, M>& R, filters::Gate gate) {
  return offsets_.correct<M>(belief_, model(belief_.mean), R, gate);
}

template <int M, class Model>
filters::Correction<M> AdditiveEkf::correct(const Model& model, const Matrix<M, M>& R, filters::Gate gate) {
  return correctWith<M>(model(x_), R, gate);
}

template <int M, class Model>
ManifoldUkf::Cloud<M> ManifoldUkf::seenThrough(const Model& model) const {
  const Matrix<15, 15> L = weights_.scale * root();
  Eigen::Matrix<double, M, 31> nu;
  nu.col(0) = model(belief_.mean).nu;
  for (int i = 0; i < 15; ++i) {
    const Vector<15> d = L.col(i);
    nu.col(1 + i) = model(plus(belief_.mean, d)).nu;
    nu.col(16 + i) = model(plus(belief_.mean, Vector<15>(-d))).nu;
  }
  Cloud<M> cloud;
  // Differences to the middle point first: the weights are large and of both signs.
  const Vector<M> middle = nu.col(0);
  nu.colwise() -= middle;
  const Vector<M> shift = weights_.other * nu.rightCols(30).rowwise().sum();
  cloud.nu = middle + shift;
  nu.colwise() -= shift;
  cloud.spread = weights_.first_covariance * nu.col(0) * nu.col(0).transpose();
  cloud.cross.setZero();
  for (int i = 0; i < 15; ++i) {
    cloud.spread += weights_.other *
                    (nu.col(1 + i) * nu.col(1 + i).transpose() + nu.col(16 + i) * nu.col(16 + i).transpose());
    cloud.cross -= weights_.other * L.col(i) * (nu.col(1 + i) - nu.col(16 + i)).transpose();
  }
  return cloud;
}

template <int M>
filters::Correction<M> ManifoldUkf::correctWith(const Cloud<M>& cloud, const Matrix<M, M>& R,
                                                filters::Gate gate) {
  auto told = judged<M>(cloud.nu, cloud.spread + R, gate);
  if (told.verdict != Verdict::Applied) return told;
  const Matrix<15, M> K = told.S.llt().solve(cloud.cross.transpose()).transpose();
  const Vector<15> d = K * told.nu;
  belief_.mean = plus(belief_.mean, d);
  belief_.covariance -= K * told.S * K.transpose();
  filters::symmetrise(belief_.covariance);
  ins::turnAttitude(belief_.covariance, ins::rightJacobian(d.segment<3>(EskfState::kAttitude)));
  return told;
}

template <int M, class Model>
filters::Correction<M> ManifoldUkf::correct(const Model& model, const Matrix<M, M>& R, filters::Gate gate) {
  return correctWith<M>(seenThrough<M>(model), R, gate);
}

}  // namespace pos::estimation
