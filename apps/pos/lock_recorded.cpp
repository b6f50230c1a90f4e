/// Vehicles whose positions are in files, under the locks.

#include <algorithm>
#include <cmath>

#include "lock_yard.hpp"
#include "pos/core/error.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::app {
namespace {

constexpr double kAskAhead = 40.0;      // m before the end of the leave ...
constexpr double kAskAheadTime = 10.0;  // ... and so many seconds of driving
constexpr double kArrived = 1.0;        // m
constexpr double kNear = 3.0;           // m beyond the wall and 3 sigma: off the map

std::vector<Estimate> readPositions(const std::filesystem::path& file) {
  auto estimates = file.extension() == ".csv" ? io::readEstimateCsv(file) : io::readTum(file);
  if (estimates.empty())
    throw DataError(Complaint{.what = "the file holds no position", .place = {.file = file.string()}});
  return estimates;
}

/// One recorded vehicle.
struct Driver {
  map::RouteLine line;
  interval::Way way;
  std::size_t stop = 0;  ///< it may drive to
  std::optional<double> distance = {};
  double speed = 0.0;
  Stamp last = {};
  bool asked = false;
  bool home = false;
};

/// A position of one of them.
struct Position {
  std::size_t driver = 0;
  Estimate estimate;
};

class Recorded {
 public:
  Recorded(const LockYard& yard, const io::LocksConfig& config, const traffic::TrafficWatch& watch)
      : yard_(yard),
        watch_(watch),
        engine_(yard.locks().site(), config.rules),
        audit_(yard.locks().site(), config.rules) {
    for (std::size_t i = 0; i < config.vehicles.size(); ++i) {
      const io::LockVehicle& v = config.vehicles[i];
      const map::RouteLine line = yard.route(v.route);
      max_speeds_.push_back(v.max_speed);
      drivers_.push_back({v.reversed ? line.reversed() : line, yard.ways()[i]});
      for (const Estimate& estimate : readPositions(v.file)) positions_.push_back({i, estimate});
    }
    std::stable_sort(positions_.begin(), positions_.end(), [](const Position& a, const Position& b) {
      return a.estimate.stamp < b.estimate.stamp;
    });
    start_ = positions_.front().estimate.stamp;
    now_ = start_;
    for (std::size_t i = 0; i < drivers_.size(); ++i) {
      const io::LockVehicle& v = config.vehicles[i];
      tell(interval::Enrol{static_cast<int>(i), v.front, v.rear, v.max_speed, v.priority});
      tell(interval::Begin{static_cast<int>(i), drivers_[i].way});
    }
  }

  traffic::TrafficResult run() {
    for (const Position& position : positions_) {
      now_ = position.estimate.stamp;
      take(position);
      tell(interval::Tick{});
    }
    result_.tally = audit_.tally();
    result_.findings = audit_.findings();
    result_.simulated = seconds(now_ - start_);
    return result_;
  }

 private:
  template <class What>
  void tell(const What& what) {
    const interval::LockEvent event{stampFromSeconds(seconds(now_ - start_)), what};
    const auto records = engine_.take(event);
    audit_.take(event, records);
    if (watch_.event) watch_.event(event, records);
    for (const interval::LockRecord& r : records) {
      if (r.kind != interval::LockRecord::Kind::Granted) continue;
      Driver& d = drivers_[static_cast<std::size_t>(r.vehicle)];
      while (d.way.stops[d.stop].stop != r.stop) ++d.stop;
      d.asked = false;
    }
  }

  /// Metres along the route, nearest to where it was; nothing off the roadways of its route.
  std::optional<double> along(const Driver& d, const Estimate& estimate, double sigma) const {
    std::optional<double> best;
    const double before = d.distance.value_or(0.0);
    for (const auto& near :
         yard_.network().candidates(estimate.T_map_body.translation, kNear + 3.0 * sigma)) {
      for (const double at : d.line.distancesOf(near.point.roadway, near.point.chainage)) {
        if (!best || std::abs(at - before) < std::abs(*best - before)) best = at;
      }
    }
    return best;
  }

  void take(const Position& position) {
    Driver& d = drivers_[position.driver];
    if (d.home) return;
    const auto P = position.estimate.planarCovariance();
    const double sigma = std::sqrt(std::max(0.0, P(0, 0) + P(1, 1)));
    const auto at = along(d, position.estimate, sigma);
    note(d, at, position.estimate);
    const auto vehicle = static_cast<interval::VehicleId>(position.driver);
    const bool near_end =
        d.way.stops[d.stop].at - d.distance.value_or(0.0) < kAskAhead + kAskAheadTime * d.speed;
    if (!d.asked && near_end && d.stop + 1 < d.way.stops.size()) {
      d.asked = true;
      tell(interval::Request{vehicle});
    }
    interval::Report report{.vehicle = vehicle, .distance = d.distance.value_or(0.0), .sigma = sigma};
    report.speed = toldSpeed(d, position);
    if (!at) report.integrity = interval::Report::Integrity::Alarm;
    tell(report);
    if (places_.empty() || now_ - told_ >= durationFromSeconds(1.0)) tellPlaces();
    const bool arrived =
        d.stop + 1 == d.way.stops.size() && report.distance > d.way.stops.back().at - kArrived;
    if (!arrived) return;
    tell(interval::Parked{vehicle, d.stop});
    d.home = true;
    ++result_.ways_finished;
  }

  /// As the file tells it; otherwise from the way since the last position, unless that was a jump.
  std::optional<double> toldSpeed(const Driver& d, const Position& position) const {
    if (position.estimate.twist) return position.estimate.twist->rates[0];
    return d.speed <= max_speeds_[position.driver] ? std::optional(d.speed) : std::nullopt;
  }

  void note(Driver& d, const std::optional<double>& at, const Estimate& estimate) {
    if (at && d.distance) {
      const double dt = seconds(estimate.stamp - d.last);
      if (dt > 0.0) d.speed = std::max(0.0, (*at - *d.distance) / dt);
      result_.driven += std::abs(*at - *d.distance);
    }
    if (at) d.distance = at;
    d.last = estimate.stamp;
  }

  void tellPlaces() {
    places_.clear();
    for (std::size_t i = 0; i < drivers_.size(); ++i) {
      if (drivers_[i].distance && !drivers_[i].home)
        places_.push_back({static_cast<int>(i), &drivers_[i].way, *drivers_[i].distance});
    }
    told_ = now_;
    if (watch_.places) watch_.places(seconds(now_ - start_), places_);
  }

  const LockYard& yard_;
  const traffic::TrafficWatch& watch_;
  interval::LockEngine engine_;
  interval::LockAudit audit_;
  std::vector<Driver> drivers_;
  std::vector<double> max_speeds_;  ///< m/s
  std::vector<Position> positions_;
  std::vector<traffic::TruePlace> places_;
  traffic::TrafficResult result_;
  Stamp start_ = {};
  Stamp now_ = {};
  Stamp told_ = {};
};

}  // namespace

traffic::TrafficResult runRecorded(const LockYard& yard, const io::LocksConfig& config,
                                   const traffic::TrafficWatch& watch) {
  return Recorded(yard, config, watch).run();
}

}  // namespace pos::app
