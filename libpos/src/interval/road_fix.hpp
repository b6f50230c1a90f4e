#pragma once
/// A fix in the directions of a road.

#include "pos/core/measurement.hpp"
#include "pos/interval/road_tracker.hpp"

namespace pos::interval {

/// Sigma of an even spread over the width, m.
inline double widthSigma(const map::Roadway& roadway) {
  return roadway.width / std::sqrt(12.0);
}

/// At the foot of the hypothesis, sigmas (m) along and across the road and upwards.
inline PassageFix roadFix(const RoadHypothesis& on, double along, double across, double up) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = rotation2(on.foot.heading);
  const Eigen::Vector3d variances(along * along, across * across, up * up);
  PassageFix fix{.p_map = on.foot.p_map};
  fix.covariance = R * variances.asDiagonal() * R.transpose();
  fix.covariance = (0.5 * (fix.covariance + fix.covariance.transpose())).eval();
  return fix;
}

}  // namespace pos::interval
