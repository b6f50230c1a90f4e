#pragma once
/// A short drive whose errors are what a filter is told: start, inertial unit and readings are drawn from the
/// very densities that the filter believes. What a filter claims of itself can be counted against it.

#include <cmath>

#include "pos/core/random.hpp"
#include "pos/estimation/eskf_models.hpp"

namespace pos::testing {

using estimation::EskfState;

class HonestWorld {
 public:
  static constexpr double kStep = 0.01;  ///< s

  explicit HonestWorld(std::uint64_t seed) : random_(seed, 7) {
    Vector<15> sigma;
    sigma << Vector<3>::Constant(0.3), Vector<3>::Constant(0.1), 0.01, 0.01, 0.03, Vector<3>::Constant(0.02),
        Vector<3>::Constant(5e-4);
    start_.mean.v_map = {2, 0, 0};
    start_.covariance = sigma.cwiseAbs2().asDiagonal();
    Vector<15> n;
    for (int i = 0; i < 15; ++i) n[i] = random_.normal();
    truth_ = plus(start_.mean, Vector<15>(sigma.cwiseProduct(n)));
  }

  const ins::EskfProcess& process() const { return process_; }
  const Belief<EskfState>& start() const { return start_; }
  const EskfState& truth() const { return truth_; }
  double normal() { return random_.normal(); }
  Eigen::Vector3d normal3() { return normals(random_); }

  /// Moves on by kStep; what the inertial unit reads meanwhile.
  ins::ImuIncrement moved() {
    ++steps_;
    const Eigen::Vector3d rate(0.02 * std::sin(0.01 * steps_), 0.01, 0.1);
    const Eigen::Vector3d force(0.1 * std::sin(0.02 * steps_), 0.2, 9.80665);
    const double root = std::sqrt(kStep);
    const ins::ImuIncrement clean{kStep * (rate + truth_.gyro_bias),
                                  kStep * (force + truth_.accelerometer_bias), kStep};
    ins::ImuIncrement read = clean;
    read.angle += process_.gyro_density * root * normals(random_);
    read.velocity += process_.accelerometer_density * root * normals(random_);
    truth_ = ins::steppedMean(truth_, clean, process_.gravity);
    truth_.gyro_bias += process_.gyro_bias_walk * root * normals(random_);
    truth_.accelerometer_bias += process_.accelerometer_bias_walk * root * normals(random_);
    return read;
  }

  /// nu' P^-1 nu of all fifteen errors, and of the position's three.
  double nees(const Belief<EskfState>& belief) const { return squared<15>(belief); }
  double neesOfPosition(const Belief<EskfState>& belief) const { return squared<3>(belief); }

 private:
  template <int N>
  double squared(const Belief<EskfState>& belief) const {
    const Vector<N> e = minus(truth_, belief.mean).head<N>();
    return e.dot(belief.covariance.topLeftCorner<N, N>().llt().solve(e));
  }

  RandomStream random_;
  ins::EskfProcess process_;
  Belief<EskfState> start_;
  EskfState truth_;
  int steps_ = 0;
};

}  // namespace pos::testing
