#pragma once
/// A scenario in motion: all its sensors merged into one stream, and the truth beside it.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/estimate.hpp"
#include "pos/map/tunnel_map.hpp"
#include "pos/sim/motion.hpp"
#include "pos/sim/sensor.hpp"

namespace pos::sim {

struct Scenario;

/// Makes the measurements of a scenario one at a time, in order of arrival; memory does not grow with its
/// length. The truth is asked of the simulation, it is never among the measurements.
///
///   Simulation simulation(scenario, map, seed);
///   while (const auto delivery = simulation.next()) estimator.ingest(delivery->measurement);
class Simulation {
 public:
  /// `map` is the one the scenario names, loaded (empty where it names none). The same scenario, map and seed
  /// give the same deliveries bit for bit, and so does each sensor whatever other sensors there are.
  /// Throws ConfigError for a sensor that the map or the vehicle cannot serve; keys are as in the file.
  Simulation(const Scenario& scenario, std::shared_ptr<const map::TunnelMap> map, std::uint64_t seed);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// The next delivery over all sensors; equal arrivals come in the order in which the scenario lists the
  /// sensors. Nothing when the scenario is over.
  std::optional<Delivery> next();

  /// The body at `t` seconds after the start.
  Kinematics truthAt(double t) const;
  /// Its pose at a stamp.
  Pose3 truthPoseAt(Stamp stamp) const;
  const Motion& motion() const;

  Stamp start() const;
  /// How long the sensors run, s: the motion's own time, or less where the scenario says so.
  double duration() const;
  Stamp end() const { return start() + durationFromSeconds(duration()); }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Poses of a simulation at a steady rate, the start and the end among them, one at a time.
class TruthSampler {
 public:
  /// `rate` in Hz, more than 0. The simulation has to outlive the sampler.
  TruthSampler(const Simulation& simulation, double rate);
  std::optional<TruthPose> next();

 private:
  const Simulation* simulation_;
  double rate_;
  std::uint64_t count_ = 0;
  bool over_ = false;
};

/// All of them: duration * rate poses of 64 bytes.
Truth sampledTruth(const Simulation& simulation, double rate);

/// The body's pose without its derivatives.
Pose3 poseOf(const Kinematics& body);

}  // namespace pos::sim
