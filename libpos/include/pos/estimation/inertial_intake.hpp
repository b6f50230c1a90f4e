#pragma once
/// What every system with an inertial unit and wheels does with their readings before its filter sees them:
/// increments since the reading before, and standing still until level and gyro bias are known.

#include <optional>
#include <string_view>

#include "pos/core/measurement.hpp"
#include "pos/core/pose2.hpp"
#include "pos/core/verdict.hpp"
#include "pos/estimation/sins_configs.hpp"
#include "pos/ins/alignment.hpp"
#include "pos/ins/odometer.hpp"
#include "pos/ins/standstill.hpp"

namespace pos::estimation {

/// Inertial samples as increments over the time since the sample before, biases and all.
class ImuIntake {
 public:
  struct Told {
    ins::ImuIncrement raw;          ///< dt = 0 where the first sample does not say how long it took
    std::string_view refusal = {};  ///< why no inertial unit reads this, where none does
  };
  Told take(Stamp stamp, const ImuSample& sample);
  /// Of the sample before; nothing before the first.
  const std::optional<Stamp>& stamp() const { return stamp_; }
  void forget() { stamp_.reset(); }

 private:
  std::optional<Stamp> stamp_;
};

/// What the two wheels rolled since the reading before.
struct WheelReading {
  ins::WheelWay way;
  double dt = 0.0;     ///< s
  bool first = false;  ///< nothing was heard before
};

/// Ticks, speeds and odometry increments as ways of two wheels.
class WheelIntake {
 public:
  explicit WheelIntake(const ins::OdometerConfig& config) : config_(config), counter_(config) {}

  struct Told {
    WheelReading reading;
    Verdict verdict = Verdict::Applied;
    std::string_view reason = {};
  };
  Told take(Stamp stamp, const WheelTicks& ticks);
  Told take(Stamp stamp, const WheelSpeeds& speeds);
  Told take(Stamp stamp, const OdometryIncrement& odometry);

  /// The last moment at which the wheels turned.
  const std::optional<Stamp>& turned() const { return turned_; }
  void forget();

 private:
  double since(Stamp stamp) const { return stamp_ ? seconds(stamp - *stamp_) : 0.0; }
  Told heard(Stamp stamp, const ins::WheelWay& way, double dt);

  ins::OdometerConfig config_;
  ins::TickCounter counter_;
  std::optional<Stamp> stamp_;
  std::optional<Stamp> turned_;
};

/// The way before there is an attitude, by the wheels alone.
struct BlindDrive {
  Pose2 moved;
  double speed = 0.0;  ///< m/s, at its end

  void add(const WheelReading& reading, double track);
};

/// Averages over confirmed standstill before the start.
class RestAlignment {
 public:
  RestAlignment(const AlignmentConfig& config, const ins::StandstillConfig& standstill)
      : config_(config), window_(standstill.window) {}

  enum class Stage {
    Standing,  ///< not long enough yet
    Aligned,   ///< long enough
    MovedOff,  ///< the vehicle moved before the time was up: less sure
  };
  /// One sample, which `detector` has taken already.
  Stage add(const ins::ImuIncrement& raw, const ins::StandstillDetector& detector, bool wheels_turned);

  /// Whether it stood long enough for an average to be worth something.
  bool rested() const;
  const ins::RestAverage& average() const { return rested() ? rest_ : pending_; }
  void forget();

 private:
  AlignmentConfig config_;
  double window_;
  ins::RestAverage rest_;     // standing, confirmed
  ins::RestAverage pending_;  // the last window, not yet confirmed
  bool moved_ = false;
};

}  // namespace pos::estimation
