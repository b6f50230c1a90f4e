#pragma once
/// A dead-reckoning filter with the errors of encoders and a gyro.

#include <cmath>

#include "pos/core/belief.hpp"
#include "pos/core/chi_square.hpp"
#include "pos/core/estimate.hpp"
#include "pos/core/measurement.hpp"
#include "pos/filters/ekf.hpp"

namespace pos::testing {

/// x, y (m), yaw (rad), odometer scale, gyro bias (rad/s).
struct DriftState {
  static constexpr int kDof = 5;
  Vector<5> values = Vector<5>::Zero();
};
inline DriftState plus(const DriftState& x, const Vector<5>& d) {
  DriftState moved{x.values + d};
  moved.values[2] = wrapAngle(moved.values[2]);
  return moved;
}
inline Vector<5> minus(const DriftState& a, const DriftState& b) {
  Vector<5> d = a.values - b.values;
  d[2] = wrapAngle(d[2]);
  return d;
}

struct DriftNoise {
  double scale = 0.005;               ///< odometer, constant over a run
  double odometer = 0.02;             ///< m / sqrt(m)
  double gyro_bias = radians(0.005);  ///< rad/s, constant over a run
  double gyro = radians(0.02);        ///< rad / sqrt(s)
  double position = 0.3;              ///< m, at the start
  double heading = radians(0.5);      ///< at the start
};

/// Encoder and gyro with their scale and bias as states; takes fixes through `ingest`.
class DriftFilter {
 public:
  DriftFilter(const DriftNoise& noise, const Pose2& start) : noise_(noise) {
    belief_.mean.values << start.x, start.y, start.yaw, 0.0, 0.0;
    belief_.covariance =
        Vector<5>(noise.position * noise.position, noise.position * noise.position,
                  noise.heading * noise.heading, noise.scale * noise.scale, noise.gyro_bias * noise.gyro_bias)
            .asDiagonal();
  }
  void predict(double odometer, double turn, double dt) {
    DriftState& x = belief_.mean;
    const double way = odometer / (1.0 + x.values[3]);
    const double dpsi = turn - x.values[4] * dt;
    const double psi = x.values[2] + 0.5 * dpsi;
    filters::Step<DriftState> step{x, Matrix<5, 5>::Identity(), Matrix<5, 5>::Zero()};
    step.next.values[0] += way * std::cos(psi);
    step.next.values[1] += way * std::sin(psi);
    step.next.values[2] = wrapAngle(x.values[2] + dpsi);
    const Eigen::Vector2d t(std::cos(psi), std::sin(psi));
    const Eigen::Vector2d n(-t.y(), t.x());
    step.F.block<2, 1>(0, 2) = way * n;
    step.F.block<2, 1>(0, 3) = -way / (1.0 + x.values[3]) * t;
    step.F.block<2, 1>(0, 4) = -0.5 * dt * way * n;
    step.F(2, 4) = -dt;
    step.Qd.topLeftCorner<2, 2>() = noise_.odometer * noise_.odometer * std::abs(way) * t * t.transpose();
    step.Qd(2, 2) = noise_.gyro * noise_.gyro * dt;
    filters::predict(belief_, step);
  }
  Verdict ingest(const PassageFix& fix) {
    filters::Innovation<DriftState, 2> at{fix.p_map.head<2>() - belief_.mean.values.head<2>(),
                                          Matrix<2, 5>::Zero()};
    at.H.leftCols<2>().setIdentity();
    const Matrix<2, 2> R = fix.covariance.topLeftCorner<2, 2>();
    const auto done = filters::correct(belief_, at, R, filters::Gate{chiSquareQuantile(0.999, 2)});
    if (done.verdict != Verdict::Applied || !fix.yaw) return done.verdict;
    filters::Innovation<DriftState, 1> heading{Vector<1>(wrapAngle(*fix.yaw - belief_.mean.values[2])),
                                               Matrix<1, 5>::Zero()};
    heading.H(0, 2) = 1.0;
    return filters::correct(belief_, heading, Matrix<1, 1>(*fix.yaw_sigma * *fix.yaw_sigma),
                            filters::Gate{chiSquareQuantile(0.999, 1)})
        .verdict;
  }
  Estimate estimate(Stamp stamp) const {
    const Vector<5>& x = belief_.mean.values;
    return planarEstimate(stamp, {x[0], x[1], x[2]}, belief_.covariance.topLeftCorner<3, 3>());
  }
  double tracePosition() const { return belief_.covariance.trace(); }

 private:
  DriftNoise noise_;
  Belief<DriftState> belief_;
};

}  // namespace pos::testing
