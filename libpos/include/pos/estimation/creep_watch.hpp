#pragma once
/// Creep of the conveyor in each end operation, from sweeps of the gate road before and after it (Zheng et
/// al. 2021, section 3.3). Watches a shearer that goes to and fro; measures, and changes no estimate.

#include <optional>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/estimation/shearer_configs.hpp"
#include "pos/lidar/creep.hpp"

namespace pos::estimation {

/// Where the shearer is when a sweep comes.
struct CreepLook {
  Pose3 T_map_body = {};
  Eigen::Matrix3d R_face_body = Eigen::Matrix3d::Identity();  ///< x towards the coal, y from end 1 to end 2
  double station = 0.0;                                       ///< m along the face from end 1
  double speed = 0.0;                                         ///< m/s along it
  double rack = 0.0;  ///< m on the conveyor; not by an odometer over ground, which sees the creep itself
};

/// The creep of one end operation.
struct DwellCreep {
  int operation = 1;
  lidar::Creep creep = {};
  double weak_share = 0.0;  ///< of the pairs' worth, what the weaker direction has; 0.5 at best
};

class CreepWatch {
 public:
  explicit CreepWatch(const FaceConfig& face, const lidar::ScannerCalibration& calibration = {})
      : face_(face), calibration_(calibration) {}

  /// The last sweep from a stand near an end before the shearer leaves it, against the last after it came
  /// back. The creep comes once it has gone on, with the first sweep from more than 5 m off the end.
  std::optional<DwellCreep> take(const Scan2D& sweep, const CreepLook& look);
  const std::vector<DwellCreep>& creeps() const { return creeps_; }
  void forget() { *this = CreepWatch(face_, calibration_); }

 private:
  /// The walls as seen from a stand, thinned to what the registration needs.
  struct Stand {
    std::vector<lidar::WallPoint> walls;
    Pose3 T_body_sensor;
    CreepLook look;
  };

  void keepStanding(std::optional<Stand>& stand, const Scan2D& sweep, const CreepLook& look) const;
  DwellCreep measured() const;
  double endAt(int end) const { return end == 2 ? face_.length : 0.0; }

  FaceConfig face_;
  lidar::ScannerCalibration calibration_;  // of the same scanner that sees the legs
  int end_ = 1;
  bool left_ = false;
  std::optional<Stand> before_;
  std::optional<Stand> after_;
  std::vector<DwellCreep> creeps_;
};

}  // namespace pos::estimation
