#pragma once
/// Simulated wheel encoders: ticks, wheel speeds or odometry increments, with wheels that may slip.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pos/sim/motion.hpp"
#include "pos/sim/sensor.hpp"
#include "pos/sim/timing.hpp"
#include "pos/sim/vehicle.hpp"

namespace pos::sim {

/// Wheels that do not roll as the ground goes by, for a while.
struct SlipEvent {
  enum class Kind {
    Ratio,   ///< rim speed = (1 + ratio) * ground speed: spin > 0, skid < 0
    LockUp,  ///< rim speed 0
    Free     ///< rim speed = speed + amplitude * sin(2 pi frequency (t - from)), whatever the ground does
  };
  enum class Side { Both, Left, Right };
  TimeSpan window = {};
  Kind kind = Kind::Ratio;
  Side side = Side::Both;
  double ratio = 0.0;      ///< -, Ratio
  double speed = 0.0;      ///< m/s, Free
  double amplitude = 0.0;  ///< m/s, Free
  double frequency = 0.0;  ///< Hz, Free

  bool operator==(const SlipEvent&) const = default;
};

struct EncoderModel {
  enum class Output {
    Ticks,     ///< WheelTicks: cumulative counters
    Speeds,    ///< WheelSpeeds: from the ticks of the interval
    Increment  ///< OdometryIncrement: from the ticks of the interval, on an exact arc
  };
  std::string sensor = "wheels";
  Output output = Output::Ticks;
  Timing timing = {.rate = 50.0};
  double ticks_per_turn =
      4000.0;             ///< counts per turn of the wheel (lines x 4); 0: no rounding (not for Ticks)
  int counter_bits = 32;  ///< the counter runs 0 .. 2^bits - 1 and wraps; 1..62
  /// The vehicle file's figure is (1 + error) x the true one.
  double left_radius_error = 0.0;     ///< -
  double right_radius_error = 0.0;    ///< -
  double track_error = 0.0;           ///< - (paper B: +0.0378)
  double distance_noise = 0.0;        ///< m per sqrt(m) rolled, each wheel: micro slip, adds up
  double speed_sigma = 0.0;           ///< m/s, each wheel and reading; Speeds only
  double yaw_sigma = 0.0;             ///< rad, each increment; Increment only
  bool claims_covariance = false;     ///< Increment: carry the covariance that the noises above amount to
  std::vector<SlipEvent> slips = {};  ///< must not overlap on one side

  bool operator==(const EncoderModel&) const = default;
};

/// The model itself when it makes sense; throws ConfigError with the key.
EncoderModel validated(const EncoderModel& model);

/// Distance that each encoder wheel's rim turns during [from, to], m: the ground's way under the tyre,
/// changed by the slips. `vehicle.encoder_track` is taken as true here.
WheelPair rimTravel(const Motion& motion, const Vehicle& vehicle, const std::vector<SlipEvent>& slips,
                    double from, double to);

/// The stream, as long as the motion. The first reading is at the phase; Speeds and Increment begin one
/// interval later. Ticks count from 0 at the start of the scenario. Memory constant.
std::unique_ptr<SensorStream> makeEncoderStream(const EncoderModel& model, const Vehicle& vehicle,
                                                std::shared_ptr<const Motion> motion, const RunSetup& run);

}  // namespace pos::sim
