#pragma once
/// A vehicle that is watched, not steered, told to the lock engine: it asks ahead of every stop and drives
/// whatever the answer is.

#include <functional>
#include <optional>

#include "pos/core/estimate.hpp"
#include "pos/interval/lock_events.hpp"
#include "pos/map/routes.hpp"

namespace pos::app {

/// The route with this id. Throws ConfigError with a suggestion for one that the map does not have.
map::RouteLine routeOf(const map::Network& network, const std::string& id);

class LockDriver {
 public:
  /// Takes what the engine is to be told; granted() may be called meanwhile.
  using Tell = std::function<void(const decltype(interval::LockEvent::what)&)>;

  /// `way` is that of `line`; `max_speed` in m/s.
  LockDriver(interval::VehicleId vehicle, map::RouteLine line, interval::Way way, double max_speed)
      : vehicle_(vehicle), line_(std::move(line)), way_(std::move(way)), max_speed_(max_speed) {}

  /// A position: perhaps a request, a report, and the arrival at the way's end, after which nothing is told.
  void drive(const map::Network& network, const Estimate& estimate, const Tell& tell);
  /// It may drive to this stop of the site.
  void granted(std::size_t stop);

  const interval::Way& way() const { return way_; }
  std::optional<double> distance() const { return distance_; }  ///< m along the way
  double driven() const { return driven_; }                     ///< m
  bool home() const { return home_; }

 private:
  std::optional<double> along(const map::Network& network, const Estimate& estimate, double sigma) const;
  void note(const std::optional<double>& at, const Estimate& estimate);
  std::optional<double> toldSpeed(const Estimate& estimate) const;

  interval::VehicleId vehicle_;
  map::RouteLine line_;
  interval::Way way_;
  double max_speed_;
  std::size_t stop_ = 0;  ///< it may drive to
  std::optional<double> distance_;
  double speed_ = 0.0;
  double driven_ = 0.0;
  Stamp last_ = {};
  bool asked_ = false;
  bool home_ = false;
};

}  // namespace pos::app
