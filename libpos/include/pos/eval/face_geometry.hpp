#pragma once
/// What a shearer's track says of a longwall face: its cuts and how straight they are, its stands at the ends
/// and what the conveyor moved between them. From the track alone, so that every estimator is looked at in
/// one way.

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/estimate.hpp"

namespace pos::eval {

/// The face as surveyed. Face axes: lateral to the right of the heading (towards the coal), station along it
/// from end 1, height above the map's zero; m.
struct FaceLine {
  Eigen::Vector2d end_1 = Eigen::Vector2d::Zero();  ///< m, map: where the shearer stands at end 1
  double heading = 1.5707963267948966;              ///< rad in the map, from end 1 to end 2
  double length = 350.0;                            ///< m
  double end_zone = 5.0;                            ///< m: standing this near an end is a stand at it
};

/// (lateral, station, height) of a place on the map.
Eigen::Vector3d onFace(const Eigen::Vector3d& p_map, const FaceLine& line);

struct FacePoint {
  Stamp stamp = {};
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< lateral, station, height
  std::optional<Eigen::Vector3d> truth = {};        ///< the same
};

/// A place of the conveyor off the straight line that fits its cut best.
struct ProfilePoint {
  double station = 0.0;
  double bend = 0.0;   ///< m, towards the coal
  double floor = 0.0;  ///< m, upwards
  std::optional<double> true_bend = {};
  std::optional<double> true_floor = {};
};

/// One pass along the face, or as much of it as the run holds.
struct Cut {
  int number = 1;
  int to_end = 2;
  bool complete = false;                   ///< it reached its end
  std::size_t first = 0;                   ///< in FaceGeometry::track
  std::size_t past = 0;                    ///< one past its last
  std::vector<ProfilePoint> profile = {};  ///< every metre, station upwards
  double bend_range = 0.0;                 ///< m, from the farthest left to the farthest right of the line
  std::optional<double> true_bend_range = {};
  std::optional<double> bend_error = {};  ///< m, r.m.s. of bend less true bend
};

/// A stand at an end: on arrival, and again after the end operation.
struct FaceStand {
  int cut = 1;  ///< finished before it
  int end = 2;
  bool after = false;  ///< the end operation
  Stamp stamp = {};
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< lateral, station, height
  std::optional<Eigen::Vector3d> error = {};        ///< of these, less the truth's
};

/// What the conveyor moved in an end operation: by the track, and where a system measures it, by sweeps.
struct EndOperation {
  int number = 1;
  int end = 2;
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();  ///< from stand to stand: advance, along the face, up
  std::optional<Eigen::Vector3d> truth = {};        ///< the same
  std::optional<double> creep = {};                 ///< m along the heading
  double creep_sigma = 0.0;
};

struct FaceGeometry {
  FaceLine line = {};
  std::vector<FacePoint> track = {};
  std::vector<Cut> cuts = {};
  std::vector<FaceStand> stands = {};
  std::vector<EndOperation> operations = {};
};

/// `estimates` in time order, one to ten a second; `truth` may be null. The creep of end operation n is the
/// quantity `creep_<n>_m` of `diagnostics`.
FaceGeometry faceGeometry(const std::vector<Estimate>& estimates, const Truth* truth, const FaceLine& line,
                          const Diagnostics& diagnostics = {});

/// Figures of a face by name: `face.stand_<n>.lateral_error_m`, `face.operation_<n>.creep_error_m`, ...; n
/// counts from 1 in the order of the run.
std::map<std::string, std::optional<double>> faceMetrics(const FaceGeometry& face);

/// The face as one of the estimators of a run saw it.
struct EstimatorFace {
  std::string name;
  FaceGeometry face;
};

}  // namespace pos::eval
