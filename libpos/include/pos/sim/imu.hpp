#pragma once
/// A simulated inertial unit: exact increments of angle and velocity over each sample interval, then errors.

#include <memory>
#include <string>

#include "pos/core/measurement.hpp"
#include "pos/sim/earth.hpp"
#include "pos/sim/motion.hpp"
#include "pos/sim/sensor.hpp"
#include "pos/sim/timing.hpp"

namespace pos::sim {

/// Errors of three like axes, gyros (unit U = rad/s) or accelerometers (U = m/s^2). A reading is
///   (I + misalignment) (1 + scale) truth + bias (+ moving bias) + instability + walk + noise, limited, then
/// rounded.
struct TriadErrors {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();  ///< U, the same in every run
  double bias_sigma = 0.0;                         ///< U, drawn once a run per axis (repeatability)
  /// U, added while the vehicle moves: what shaking does to the bias, which standing still does not show
  Eigen::Vector3d moving_bias = Eigen::Vector3d::Zero();
  double noise_density = 0.0;       ///< U/sqrt(Hz) = U sqrt(s): angle or velocity random walk
  double instability_sigma = 0.0;   ///< U, standard deviation of a first-order Gauss-Markov bias
  double instability_time = 100.0;  ///< s, its correlation time
  double walk_density = 0.0;  ///< U/sqrt(s): random walk of the bias (rate random walk), from 0 at the start
  Eigen::Vector3d scale = Eigen::Vector3d::Zero();  ///< -, the same in every run (1e-3 = 1000 ppm)
  double scale_sigma = 0.0;                         ///< -, drawn once a run per axis
  double misalignment_sigma = 0.0;  ///< rad, drawn once a run for each of the six small angles between axes
  double quantum = 0.0;             ///< of the output: U for rates, U s for increments; 0 = none
  double limit = 0.0;               ///< U, full scale; 0 = none

  bool operator==(const TriadErrors&) const = default;
};

struct ImuErrors {
  TriadErrors gyro = {};
  TriadErrors accelerometer = {};

  bool operator==(const ImuErrors&) const = default;
};

/// Presets of the papers, for tests and defaults.
ImuErrors perfectImu();
ImuErrors automotiveMems();  ///< P1 A3.3: 2e-4, 2e-3, walks 1e-6, 1e-4, biases 5e-4 rad/s and 0.02 m/s^2
ImuErrors
laboratoryMems();  ///< paper B section 5: 0.01 deg/s/sqrt(Hz), bias 0.02 deg/s; 200 ug/sqrt(Hz), 2 mg
ImuErrors
navigationGrade();  ///< P2 Table 2: +0.05 deg/h, 0.01 deg/sqrt(h); +50 ug, 10 ug/sqrt(Hz) on every axis

struct ImuModel {
  std::string sensor = "imu";
  ImuSample::Kind kind = ImuSample::Kind::Rates;  ///< Rates are averages over the interval
  Timing timing = {.rate = 100.0};
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< m, where it sits; its axes are the body's
  ImuErrors errors = {};

  bool operator==(const ImuModel&) const = default;
};

/// The model itself when it makes sense; throws ConfigError with the key.
ImuModel validated(const ImuModel& model);

/// Exact increments over [from, to]: integrals of the body's rate against the stars and of the specific force
/// at `p_body`, in body axes (rad, m/s). Smooth stretches by Gauss-Legendre with three nodes per 20 ms, split
/// at the motion's breaks; where a speed or a rate jumps, the jump belongs to the increment.
struct InertialIncrement {
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};
InertialIncrement inertialIncrement(const Motion& motion, const Earth& earth, const Eigen::Vector3d& p_body,
                                    double from, double to);

/// The stream, as long as the motion. A sample is stamped at the end of its interval, which reaches back to
/// the sample before it; the first is the first whose interval lies after the start. Memory constant, about 1
/// us a sample.
std::unique_ptr<SensorStream> makeImuStream(const ImuModel& model, std::shared_ptr<const Earth> earth,
                                            std::shared_ptr<const Motion> motion, const RunSetup& run);

}  // namespace pos::sim
