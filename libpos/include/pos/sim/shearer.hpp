#pragma once
/// The shearer on its conveyor: passes along the face, the end operation between them, the advance, creep and
/// bend of the conveyor (Zheng et al. 2021, section 4; timetable partly inferred, see
/// docs/math/simulator_truth.md).
///
/// Map: x is the direction in which the face advances, y runs along the face from end 1 (station 0) to end 2
/// (station pass_length), z up. The body's x axis looks along the conveyor towards end 2, also when the
/// shearer drives back.

#include <cstdint>
#include <memory>
#include <vector>

#include "pos/sim/motion.hpp"

namespace pos::sim {

struct ShearerConfig {
  int passes = 6;                  ///< cutting cycles; one end operation between two of them
  double pass_length = 350.0;      ///< m, conveyor less shearer
  double pass_time = 3540.0;       ///< s
  double dwell_time = 872.0;       ///< s, the end operation
  double excursion = 43.1;         ///< m away from the end and back during the end operation
  double standstill = 10.0;        ///< s at each reversal; all three lie within the end operation
  double acceleration = 0.05;      ///< m/s^2 of every start and stop
  double s_bend_from = 10.0;       ///< m from the end: where the conveyor leaves its old line ...
  double s_bend_to = 35.0;         ///< m from the end: ... and lies on the new one
  double advance = 1.0;            ///< m in +x per cycle
  std::vector<double> creep = {};  ///< m in +y in each end operation; none where the list ends
  double bend_peak = 0.0;          ///< m, horizontal bend of the conveyor, different every cycle
  double floor_peak = 0.0;         ///< m, waves of the floor, different every cycle
  double inherited = 0.5;          ///< share of the previous cycle's bend that stays
  std::uint64_t seed = 1;          ///< of the bends
  double support_lag = 11.0;       ///< m behind the shearer's centre, from which the supports have moved on

  bool operator==(const ShearerConfig&) const = default;
};

/// The config itself when it can be driven; throws ConfigError.
ShearerConfig validated(const ShearerConfig& config);

/// The shearer's motion, and the conveyor and supports it moves among. Lines are counted from 0: pass c runs
/// on line c.
class ShearerMotion : public Motion {
 public:
  /// m along the face at `t`, without creep: what the rack counts.
  virtual double stationAt(double t) const = 0;
  /// The line of the pass at `t`; during an end operation the one before.
  virtual int lineAt(double t) const = 0;
  /// A point of the conveyor (m, map) lying on its line `line`; stations may lie beyond both ends.
  virtual Eigen::Vector3d pointOnLine(int line, double station) const = 0;
  /// The line by which the support at `station` stands at `t`: line c before the shearer of pass c has gone
  /// by, c + 1 after; the last ones move in the end operation, once the shearer has passed the S-bend.
  virtual int supportLine(double station, double t) const = 0;
};

/// Throws ConfigError. Every query costs O(log passes).
std::unique_ptr<ShearerMotion> makeShearerMotion(const ShearerConfig& config);

}  // namespace pos::sim
