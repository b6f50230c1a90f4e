#include "lock_yard.hpp"

#include "lock_driver.hpp"
#include "pos/traffic/ways.hpp"
#include "verb_map.hpp"

namespace pos::app {
namespace {

map::DivisionRules divisionOf(const io::LocksConfig& config) {
  map::DivisionRules rules;
  rules.merge = config.merge;
  return rules;
}

}  // namespace

LockYard::LockYard(const io::LocksConfig& config)
    : network_(std::make_shared<const map::TunnelMap>(mapOf(config.map.string()))),
      graph_(network_),
      intervals_(map::divided(graph_, network_, divisionOf(config))),
      locks_(network_, graph_, intervals_, config.sections),
      rules_(validated(config.rules)) {
  using Ways = io::LocksConfig::Ways;
  if (config.traffic && config.ways != Ways::Routes) ways_ = traffic::waysBetweenEnds(graph_, locks_);
  if (config.traffic && config.ways != Ways::Ends) {
    const auto routes = traffic::waysOfRoutes(network_, locks_);
    ways_.insert(ways_.end(), routes.begin(), routes.end());
  }
  for (const io::LockVehicle& vehicle : config.vehicles) {
    const map::RouteLine line = route(vehicle.route);
    ways_.push_back(locks_.way(vehicle.reversed ? line.reversed() : line));
  }
}

io::LockScene LockYard::scene() const {
  return {*locks_.site(), rules_, ways_};
}

map::RouteLine LockYard::route(const std::string& id) const {
  return routeOf(network_, id);
}

}  // namespace pos::app
