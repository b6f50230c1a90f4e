/// Vehicles whose positions are in files, under the locks.

#include <algorithm>

#include "lock_driver.hpp"
#include "lock_yard.hpp"
#include "pos/core/error.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::app {
namespace {

std::vector<Estimate> readPositions(const std::filesystem::path& file) {
  auto estimates = file.extension() == ".csv" ? io::readEstimateCsv(file) : io::readTum(file);
  if (estimates.empty())
    throw DataError(Complaint{.what = "the file holds no position", .place = {.file = file.string()}});
  return estimates;
}

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
      drivers_.emplace_back(static_cast<int>(i), v.reversed ? line.reversed() : line, yard.ways()[i],
                            v.max_speed);
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
      tell(interval::Begin{static_cast<int>(i), drivers_[i].way()});
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
    for (const LockDriver& driver : drivers_) {
      result_.driven += driver.driven();
      if (driver.home()) ++result_.ways_finished;
    }
    return result_;
  }

 private:
  void tell(const decltype(interval::LockEvent::what)& what) {
    const interval::LockEvent event{stampFromSeconds(seconds(now_ - start_)), what};
    const auto records = engine_.take(event);
    audit_.take(event, records);
    if (watch_.event) watch_.event(event, records);
    for (const interval::LockRecord& r : records) {
      if (r.kind == interval::LockRecord::Kind::Granted)
        drivers_[static_cast<std::size_t>(r.vehicle)].granted(r.stop);
    }
  }

  void take(const Position& position) {
    drivers_[position.driver].drive(yard_.network(), position.estimate, [&](const auto& what) {
      tell(what);
      const bool due = places_.empty() || now_ - told_ >= durationFromSeconds(1.0);
      if (std::holds_alternative<interval::Report>(what) && due) tellPlaces();
    });
  }

  void tellPlaces() {
    places_.clear();
    for (std::size_t i = 0; i < drivers_.size(); ++i) {
      if (drivers_[i].distance() && !drivers_[i].home())
        places_.push_back({static_cast<int>(i), &drivers_[i].way(), *drivers_[i].distance()});
    }
    told_ = now_;
    if (watch_.places) watch_.places(seconds(now_ - start_), places_);
  }

  const LockYard& yard_;
  const traffic::TrafficWatch& watch_;
  interval::LockEngine engine_;
  interval::LockAudit audit_;
  std::vector<LockDriver> drivers_;
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
