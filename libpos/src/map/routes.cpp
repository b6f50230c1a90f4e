#include "pos/map/routes.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"

namespace pos::map {
namespace {

/// Stretches that follow each other on one roadway as one.
std::vector<DrivenStretch> joined(const std::vector<DrivenStretch>& stretches) {
  std::vector<DrivenStretch> legs;
  for (const DrivenStretch& next : stretches) {
    const bool goes_on =
        !legs.empty() && legs.back().roadway == next.roadway && legs.back().to == next.from &&
        (legs.back().length() == 0.0 || next.length() == 0.0 || legs.back().direction() == next.direction());
    if (goes_on) {
      legs.back().to = next.to;
    } else {
      legs.push_back(next);
    }
  }
  return legs;
}

std::vector<DrivenStretch> drivenLegs(const Network& network, const Route& route) {
  std::vector<DrivenStretch> legs;
  for (const RoadwayStretch& leg : route.legs) {
    legs.push_back({network.indexOf(leg.roadway), leg.from, leg.to});
  }
  return legs;
}

}  // namespace

RouteLine::RouteLine(const std::vector<DrivenStretch>& legs) : legs_(joined(legs)) {
  if (legs_.empty()) throw ConfigError(Complaint{.what = "a route needs at least one leg"});
  double start = 0.0;
  for (const DrivenStretch& leg : legs_) {
    starts_.push_back(start);
    start += leg.length();
  }
}

RouteLine::RouteLine(const Network& network, const Route& route) : RouteLine(drivenLegs(network, route)) {}

double RouteLine::length() const {
  return starts_.back() + legs_.back().length();
}

PlaceOnRoute RouteLine::at(double distance) const {
  const auto after = std::upper_bound(starts_.begin() + 1, starts_.end(), distance);
  const auto i = static_cast<std::size_t>(after - starts_.begin()) - 1;
  const DrivenStretch& leg = legs_[i];
  const double driven = std::clamp(distance - starts_[i], 0.0, leg.length());
  const bool forward = leg.direction() == Direction::Forward;
  return {leg.roadway, forward ? leg.from + driven : leg.from - driven, leg.direction()};
}

std::vector<double> RouteLine::distancesOf(RoadwayIndex roadway, double chainage) const {
  std::vector<double> distances;
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    const DrivenStretch& leg = legs_[i];
    const auto [low, high] = std::minmax(leg.from, leg.to);
    if (leg.roadway != roadway || chainage < low || chainage > high) continue;
    distances.push_back(starts_[i] + std::abs(chainage - leg.from));
  }
  return distances;
}

RouteLine RouteLine::reversed() const {
  std::vector<DrivenStretch> back;
  for (auto leg = legs_.rbegin(); leg != legs_.rend(); ++leg)
    back.push_back({leg->roadway, leg->to, leg->from});
  return RouteLine(back);
}

}  // namespace pos::map
