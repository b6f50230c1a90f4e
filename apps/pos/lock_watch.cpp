#include "lock_watch.hpp"

namespace pos::app {
namespace {

constexpr interval::VehicleId kVehicle = 0;

map::RouteLine lineOf(const map::Network& network, const LockedVehicle& vehicle) {
  const map::RouteLine line = routeOf(network, vehicle.route);
  return vehicle.reversed ? line.reversed() : line;
}

}  // namespace

LockedRoute::LockedRoute(const IntervalGround& ground, const LockedVehicle& vehicle)
    : vehicle_(vehicle),
      network_(ground.scene.network),
      intervals_(ground.scene.intervals.size()),
      line_(lineOf(network_, vehicle)) {
  const interval::LockMap locks(network_, ground.graph, ground.scene.intervals, {});
  site_ = locks.site();
  way_ = locks.way(line_);
}

LockDriver LockedRoute::driver(interval::VehicleId vehicle) const {
  return {vehicle, line_, way_, vehicle_.max_speed};
}

LockWatch::LockWatch(std::shared_ptr<const LockedRoute> route)
    : route_(std::move(route)), engine_(route_->site(), {}), driver_(route_->driver(kVehicle)) {}

void LockWatch::tell(Stamp stamp, const decltype(interval::LockEvent::what)& what) {
  for (const interval::LockRecord& record : engine_.take({stamp, what})) {
    if (record.kind == interval::LockRecord::Kind::Granted) driver_.granted(record.stop);
  }
}

std::vector<serve::Occupancy> LockWatch::take(const Estimate& estimate) {
  if (!begun_) {
    const LockedVehicle& vehicle = route_->vehicle();
    tell(estimate.stamp, interval::Enrol{.vehicle = kVehicle,
                                         .front = vehicle.front,
                                         .rear = vehicle.rear,
                                         .max_speed = vehicle.max_speed});
    tell(estimate.stamp, interval::Begin{kVehicle, driver_.way()});
    begun_ = true;
  }
  driver_.drive(route_->network(), estimate, [&](const auto& what) {
    if (!placed_ && std::holds_alternative<interval::Report>(what)) {  // wherever on the way the show begins
      tell(estimate.stamp, interval::Override{.action = interval::Override::Action::Trust,
                                              .vehicle = kVehicle,
                                              .who = "pos serve",
                                              .why = "first position"});
      placed_ = true;
    }
    tell(estimate.stamp, what);
  });
  tell(estimate.stamp, interval::Tick{});
  const serve::Occupancy occupied =
      engine_.view(kVehicle).believed || driver_.home() ? serve::Occupancy::Held : serve::Occupancy::Doubtful;
  std::vector<serve::Occupancy> states(route_->intervals(), serve::Occupancy::Free);
  for (const std::size_t interval : engine_.occupiedIntervals()) states[interval] = occupied;
  return states;
}

}  // namespace pos::app
