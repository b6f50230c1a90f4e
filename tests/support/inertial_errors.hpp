#pragma once
/// How errors of an inertial solution grow, from the nonlinear mechanisation of the true and of the estimated
/// solution: the oracle of every error model.

#include <vector>

#include "pos/core/pose3.hpp"
#include "pos/ins/error_model.hpp"

namespace pos::testing {

using namespace pos::ins;

using Vector15 = Eigen::Matrix<double, 15, 1>;

struct InertialCase {
  Earth earth;
  NavigationState state;
  Eigen::Vector3d omega;
  Eigen::Vector3d force;
};

/// The estimated solution whose error is `x`: C^ = (I - [phi x]) C to first order, as a rotation.
inline NavigationState disturbed(const InertialCase& c, const Vector15& x) {
  NavigationState s = c.state;
  s.q_n_b = quaternionFromRotationVector(-x.segment<3>(kPhi)) * s.q_n_b;
  s.v_n += x.segment<3>(kVelocity);
  s.coordinates += x.segment<3>(kPosition).cwiseQuotient(c.earth.at(c.state.coordinates).metric);
  return s;
}

/// Rate of dp = metric(truth) * (coordinates^ - coordinates), where both coordinates change at the rates
/// given; the metric's own rate is in it.
inline Eigen::Vector3d metresRate(const Earth& earth, const Eigen::Vector3d& truth,
                                  const Eigen::Vector3d& hat, const Eigen::Vector3d& truth_rate,
                                  const Eigen::Vector3d& hat_rate) {
  const double dt = 1e-3;
  const Eigen::Vector3d ahead = earth.at(truth + dt * truth_rate).metric;
  const Eigen::Vector3d behind = earth.at(truth - dt * truth_rate).metric;
  return earth.at(truth).metric.cwiseProduct(hat_rate - truth_rate) +
         ((ahead - behind) / (2.0 * dt)).cwiseProduct(hat - truth);
}

/// Rate of change of the error, from the nonlinear mechanisation of both solutions.
inline Vector15 errorRate(const InertialCase& c, const Vector15& x) {
  const NavigationState hat = disturbed(c, x);
  const NavigationRates truth = navigationRates(c.earth, c.state, c.omega, c.force);
  const NavigationRates wrong = navigationRates(c.earth, hat, c.omega + x.segment<3>(kGyroBias),
                                                c.force + x.segment<3>(kAccelerometerBias));
  Vector15 rate = Vector15::Zero();
  const Eigen::Matrix3d C = c.state.C_n_b();
  const Eigen::Matrix3d product = wrong.C_n_b * C.transpose() + hat.C_n_b() * truth.C_n_b.transpose();
  const Eigen::Matrix3d odd = -0.5 * (product - product.transpose());
  rate.segment<3>(kPhi) << odd(2, 1), odd(0, 2), odd(1, 0);
  rate.segment<3>(kVelocity) = wrong.v_n - truth.v_n;
  rate.segment<3>(kPosition) = metresRate(c.earth, c.state.coordinates, hat.coordinates, truth.p, wrong.p);
  return rate;
}

inline std::vector<InertialCase> inertialCases() {
  std::vector<InertialCase> all;
  for (const bool flat : {true, false}) {
    for (const double yaw : {0.0, 1.2, 3.1415, -2.0}) {
      InertialCase c{flat ? Earth::flat() : Earth::ellipsoid(), {}, {0.02, -0.03, 0.2}, {0.4, -0.7, 9.9}};
      c.state.q_n_b = Pose3::fromXyzYawPitchRoll(0, 0, 0, yaw, 0.15, -0.08).rotation;
      c.state.v_n = {3.6, -2.0, 0.4};
      c.state.coordinates = flat ? Eigen::Vector3d(100, 50, -20) : Eigen::Vector3d(1.9, 0.61, -350.0);
      all.push_back(c);
    }
  }
  return all;
}

}  // namespace pos::testing
