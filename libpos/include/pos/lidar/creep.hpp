#pragma once
/// Creep of the face along itself, from two sweeps of a gate road (Zheng et al. 2021, eq. 9; spec B, B7).

#include <Eigen/Core>

#include "pos/core/pose3.hpp"
#include "pos/lidar/icp.hpp"

namespace pos::lidar {

/// Two stands at one end of the face, before and after the advance.
struct DwellStand {
  Pose3 T_body_sensor = {};  ///< of the scanner, FLU body axes
  /// Body axes at the first sweep to the face frame at the start of the run: x towards the coal, y from end 1
  /// to end 2, z up (the paper's m(t0)).
  Eigen::Matrix3d R_face_body = Eigen::Matrix3d::Identity();
  double stop_difference = 0.0;        ///< m, the conveyor's coordinate of the second stop less the first's
  double stop_difference_sigma = 0.0;  ///< m
};

struct Creep {
  double value = 0.0;    ///< m, towards end 2 positive, towards roadway 1 negative, at either end
  double advance = 0.0;  ///< m, towards the coal, as the sweeps saw it
  double sigma = 0.0;    ///< m, of value
  bool usable = false;   ///< the registration converged and holds the direction of the face
};

/// What the conveyor moved along the face between the two sweeps, beyond what the shearer itself drove on
/// it.
Creep creepOf(const IcpResult& registration, const DwellStand& stand);

}  // namespace pos::lidar
