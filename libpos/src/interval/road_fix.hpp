#pragma once
/// A fix in the directions of a road.

#include "pos/core/measurement.hpp"
#include "pos/interval/road_tracker.hpp"

namespace pos::interval {

/// Sigma of an even spread over the width, m.
inline double widthSigma(const map::Roadway& roadway) {
  return roadway.width / std::sqrt(12.0);
}

/// Where between the walls a vehicle is, as far as its road tells.
struct PlaceAcross {
  double offset = 0.0;  ///< m, to the left of the path positive
  double sigma = 0.0;   ///< m
};

inline PlaceAcross anywhereBetweenTheWalls(const map::Roadway& roadway) {
  return {0.0, widthSigma(roadway)};
}

/// Of two lanes it is the one on the driving side of the way that the vehicle faces (a reversing one keeps
/// its lane), anywhere in it. One lane, or two of one direction: anywhere between the walls.
inline PlaceAcross placeInLane(const map::Roadway& roadway, map::Side driving_side, bool facing) {
  if (roadway.lanes != 2 || roadway.traffic != map::Traffic::BothWays)
    return anywhereBetweenTheWalls(roadway);
  const bool left = (driving_side == map::Side::Left) == facing;
  return {(left ? 0.25 : -0.25) * roadway.width, 0.5 * widthSigma(roadway)};
}

/// At the foot of the hypothesis, sigmas (m) along the road, across it and upwards.
inline PassageFix roadFix(const RoadHypothesis& on, double along, const PlaceAcross& across, double up) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = rotation2(on.foot.heading);
  const Eigen::Vector3d variances(along * along, across.sigma * across.sigma, up * up);
  PassageFix fix{.p_map = on.foot.p_map + across.offset * R.col(1)};
  fix.covariance = R * variances.asDiagonal() * R.transpose();
  fix.covariance = (0.5 * (fix.covariance + fix.covariance.transpose())).eval();
  return fix;
}

}  // namespace pos::interval
