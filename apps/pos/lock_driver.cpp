#include "lock_driver.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"
#include "pos/io/text.hpp"

namespace pos::app {
namespace {

constexpr double kAskAhead = 40.0;      // m before the end of the leave ...
constexpr double kAskAheadTime = 10.0;  // ... and so many seconds of driving
constexpr double kArrived = 1.0;        // m
constexpr double kNear = 3.0;           // m beyond the wall and 3 sigma: off the map

}  // namespace

map::RouteLine routeOf(const map::Network& network, const std::string& id) {
  std::vector<std::string> ids;
  for (const map::Route& route : network.map().routes) {
    if (route.id == id) return map::RouteLine(network, route);
    ids.push_back(route.id);
  }
  throw ConfigError(
      Complaint{.what = "the map has no such route",
                .key = "route",
                .got = id,
                .expected = ids.empty() ? "no route at all" : "one of: " + io::text::joined(ids),
                .suggestion = io::text::didYouMean(id, ids)});
}

void LockDriver::drive(const map::Network& network, const Estimate& estimate, const Tell& tell) {
  if (home_) return;
  const auto P = estimate.planarCovariance();
  const double sigma = std::sqrt(std::max(0.0, P(0, 0) + P(1, 1)));
  const auto at = along(network, estimate, sigma);
  note(at, estimate);
  const bool near_end = way_.stops[stop_].at - distance_.value_or(0.0) < kAskAhead + kAskAheadTime * speed_;
  if (!asked_ && near_end && stop_ + 1 < way_.stops.size()) {
    asked_ = true;
    tell(interval::Request{vehicle_});
  }
  interval::Report report{.vehicle = vehicle_, .distance = distance_.value_or(0.0), .sigma = sigma};
  report.speed = toldSpeed(estimate);
  if (!at) report.integrity = interval::Report::Integrity::Alarm;
  tell(report);
  if (stop_ + 1 < way_.stops.size() || report.distance <= way_.stops.back().at - kArrived) return;
  tell(interval::Parked{vehicle_, stop_});
  home_ = true;
}

void LockDriver::granted(std::size_t stop) {
  while (way_.stops[stop_].stop != stop) ++stop_;
  asked_ = false;
}

/// Metres along the route, nearest to where it was; nothing off the roadways of its route.
std::optional<double> LockDriver::along(const map::Network& network, const Estimate& estimate,
                                        double sigma) const {
  std::optional<double> best;
  const double before = distance_.value_or(0.0);
  for (const auto& near : network.candidates(estimate.T_map_body.translation, kNear + 3.0 * sigma)) {
    for (const double at : line_.distancesOf(near.point.roadway, near.point.chainage)) {
      if (!best || std::abs(at - before) < std::abs(*best - before)) best = at;
    }
  }
  return best;
}

void LockDriver::note(const std::optional<double>& at, const Estimate& estimate) {
  if (at && distance_) {
    const double dt = seconds(estimate.stamp - last_);
    if (dt > 0.0) speed_ = std::max(0.0, (*at - *distance_) / dt);
    driven_ += std::abs(*at - *distance_);
  }
  if (at) distance_ = at;
  last_ = estimate.stamp;
}

/// As the estimate tells it; otherwise from the way since the last position, unless that was a jump.
std::optional<double> LockDriver::toldSpeed(const Estimate& estimate) const {
  if (estimate.twist) return estimate.twist->rates[0];
  return speed_ <= max_speed_ ? std::optional(speed_) : std::nullopt;
}

}  // namespace pos::app
