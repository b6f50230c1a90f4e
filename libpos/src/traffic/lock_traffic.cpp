#include "pos/traffic/lock_traffic.hpp"

#include <algorithm>
#include <cmath>

#include "pos/core/error.hpp"
#include "vehicle.hpp"

namespace pos::traffic {
namespace {

using interval::Way;

constexpr double kPatienceInDoubt = 240.0;  // s, then the dispatcher asks the driver

void requireWayOut(const std::vector<Way>& ways, const interval::LockSite& site) {
  if (ways.empty()) throw DataError(Complaint{.what = "there is no way to drive"});
  for (const Way& way : ways) {
    const bool leads_on = std::any_of(ways.begin(), ways.end(), [&](const Way& next) {
      return next.stops.front().stop == way.stops.back().stop;
    });
    if (!leads_on) {
      throw DataError(Complaint{.what = "a vehicle could not leave again",
                                .got = "no way begins at " + site.stops[way.stops.back().stop].id,
                                .suggestion = "add a way back"});
    }
  }
}

class Traffic {
 public:
  Traffic(std::shared_ptr<const interval::LockSite> site, std::vector<Way> ways,
          const interval::LockRules& rules, const TrafficOptions& options, const TrafficWatch& watch)
      : site_(std::move(site)),
        ways_(std::move(ways)),
        options_(validated(options)),
        watch_(watch),
        random_(options.seed, 77),
        engine_(site_, rules),
        audit_(site_, rules) {
    requireWayOut(ways_, *site_);
    for (int id = 0; id < options_.vehicles; ++id) {
      vehicles_.push_back(newVehicle(id, ways_, random_));
      tell(vehicles_.back().shape);
    }
  }

  TrafficResult run() {
    double quiet = 0.0;
    while (!finished() && result_.deadlocks == 0) {
      t_ += 1.0;
      const std::size_t granted = audit_.tally().granted;
      maybeRestart();
      for (Vehicle& v : vehicles_) step(v);
      result_.opposing += anyOpposing(vehicles_) ? 1 : 0;
      tell(interval::Tick{});
      tellPlaces();
      const bool somebody_waits =
          std::any_of(vehicles_.begin(), vehicles_.end(), [](const Vehicle& v) { return v.asked; });
      quiet = audit_.tally().granted > granted || !somebody_waits ? 0.0 : quiet + 1.0;
      if (quiet > options_.stuck_after) noteDeadlock();
    }
    result_.tally = audit_.tally();
    result_.findings = audit_.findings();
    result_.simulated = t_;
    return result_;
  }

 private:
  bool finished() const {
    return audit_.tally().requests >= options_.requests &&
           std::none_of(vehicles_.begin(), vehicles_.end(), [](const Vehicle& v) { return v.has_way; });
  }

  template <class What>
  void tell(const What& what) {
    const interval::LockEvent event{stampFromSeconds(t_), what};
    const auto records = engine_.take(event);
    audit_.take(event, records);
    if (watch_.event) watch_.event(event, records);
    for (const interval::LockRecord& record : records) {
      if (record.vehicle >= 0) hear(vehicles_[static_cast<std::size_t>(record.vehicle)], record, t_);
    }
  }

  void tellPlaces() const {
    if (!watch_.places) return;
    std::vector<TruePlace> places;
    for (const Vehicle& v : vehicles_) {
      if (v.on_road) places.push_back({v.shape.vehicle, &v.way, v.d});
    }
    watch_.places(t_, places);
  }

  void maybeRestart() {
    if (!random_.bernoulli(options_.restart_per_s)) return;
    const bool busy = std::any_of(vehicles_.begin(), vehicles_.end(),
                                  [](const Vehicle& v) { return v.announce_at >= 0.0; });
    if (busy) return;  // still with the last one
    tell(interval::Restart{});
    for (Vehicle& v : vehicles_) {
      v.announce_at = t_ + random_.uniform(1.0, 20.0);
      v.asked = false;
      v.doubted_since = -1.0;
    }
  }

  void step(Vehicle& v) {
    if (v.announce_at >= 0.0 && t_ >= v.announce_at) announce(v);
    if (!v.has_way && v.announce_at < 0.0) maybeBegin(v);
    if (!v.has_way) return;
    ask(v);
    if (!v.on_road) return;
    const double before = v.d;
    result_.driven += drive(v, vehicles_);
    report(v, before);
    park(v);
  }

  void announce(Vehicle& v) {
    v.announce_at = -1.0;
    interval::Announce told{.vehicle = v.shape.vehicle};
    if (v.has_way) told.way = v.way;
    told.stop = v.stop;
    told.rear_limit = v.rear_limit;
    told.parked = !v.on_road;
    tell(told);
    if (v.on_road) v.doubted_since = t_;
  }

  void maybeBegin(Vehicle& v) {
    if (t_ < v.idle_until || audit_.tally().requests >= options_.requests) return;
    std::vector<const Way*> from_here;
    for (const Way& way : ways_) {
      if (way.stops.front().stop == v.depot) from_here.push_back(&way);
    }
    v.way = *from_here[random_.bits() % from_here.size()];
    v.has_way = true;
    v.stop = 0;
    v.d = v.speed = 0.0;
    tell(interval::Begin{v.shape.vehicle, v.way});
  }

  void ask(Vehicle& v) {
    if (v.announce_at >= 0.0 || v.stop + 1 >= v.way.stops.size()) return;
    if (v.asked) {
      if (random_.bernoulli(0.0005)) {
        tell(interval::Withdraw{v.shape.vehicle});
        v.asked = false;
      }
      return;
    }
    if (v.way.stops[v.stop].at - v.d > 40.0 + 10.0 * v.speed) return;
    v.asked = true;
    tell(interval::Request{v.shape.vehicle});
  }

  void report(Vehicle& v, double before) {
    auto told = position(v, before, t_, options_, random_);
    if (!told) return;
    if (v.doubted_since >= 0.0 && t_ - v.doubted_since > kPatienceInDoubt) {
      tell(interval::Override{interval::Override::Action::Trust, v.shape.vehicle, "dispatcher",
                              "driver names the place by telephone"});
      told->distance = v.d + random_.normal(0.0, t_ < v.vague_until ? v.vague_sigma : v.sigma);
      v.jump_until = t_;
    }
    tell(*told);
  }

  void park(Vehicle& v) {
    const interval::WayStop& stop = v.way.stops[v.stop];
    if (site_->stops[stop.stop].kind == interval::StopPlace::Kind::OnRoad || v.d < stop.at - 0.05) return;
    const std::size_t stopped_at = v.stop;
    const bool end = v.stop + 1 == v.way.stops.size();
    v.on_road = false;
    v.speed = 0.0;
    v.doubted_since = -1.0;
    v.rear_limit = stop.from;
    if (end) {
      v.depot = stop.stop;
      v.has_way = v.asked = false;
      v.idle_until = t_ + random_.uniform(5.0, 120.0);
      ++result_.ways_finished;
    }
    if (v.announce_at < 0.0) tell(interval::Parked{v.shape.vehicle, stopped_at});
  }

  /// Everybody with a way, and what the engine answers when asked again.
  void noteDeadlock() {
    ++result_.deadlocks;
    for (const Vehicle& v : vehicles_) {
      if (!v.has_way) continue;
      const interval::StopPlace& stop = site_->stops[v.way.stops[v.stop].stop];
      result_.jam += "vehicle " + std::to_string(v.shape.vehicle) + " at " + std::to_string(v.d) + " m" +
                     (v.on_road ? " on the road to " : " parked at ") + stop.id + " at " +
                     std::to_string(v.way.stops[v.stop].at) +
                     (engine_.view(v.shape.vehicle).believed ? "" : " (not believed)");
      const interval::LockEvent again{stampFromSeconds(t_), interval::Request{v.shape.vehicle}};
      for (const interval::LockRecord& record : engine_.take(again)) {
        result_.jam +=
            "; " + std::string(name(record.kind)) + " " + record.reason + " " + std::to_string(record.other);
      }
      result_.jam += "\n";
    }
  }

  std::shared_ptr<const interval::LockSite> site_;
  std::vector<Way> ways_;
  TrafficOptions options_;
  TrafficWatch watch_;
  RandomStream random_;
  interval::LockEngine engine_;
  interval::LockAudit audit_;
  std::vector<Vehicle> vehicles_;
  TrafficResult result_;
  double t_ = 0.0;
};

void requireRate(double value, const char* key) {
  if (value >= 0.0 && value <= 1.0) return;
  throw ConfigError(Complaint{.what = "a rate of faults makes no sense",
                              .key = key,
                              .got = std::to_string(value),
                              .expected = "0 to 1 per second"});
}

}  // namespace

TrafficOptions validated(TrafficOptions options) {
  if (options.vehicles < 1 || options.vehicles > 1000) {
    throw ConfigError(Complaint{.what = "the number of vehicles makes no sense",
                                .key = "vehicles",
                                .got = std::to_string(options.vehicles),
                                .expected = "1 to 1000"});
  }
  requireRate(options.missing_per_s, "missing_rate_hz");
  requireRate(options.jump_per_s, "jump_rate_hz");
  requireRate(options.vague_per_s, "vague_rate_hz");
  requireRate(options.alarm_per_s, "alarm_rate_hz");
  requireRate(options.restart_per_s, "restart_rate_hz");
  if (!(options.stuck_after > 0.0) || !std::isfinite(options.stuck_after)) {
    throw ConfigError(Complaint{.what = "the time to a deadlock makes no sense",
                                .key = "stuck_after_s",
                                .got = std::to_string(options.stuck_after),
                                .expected = "more than 0"});
  }
  return options;
}

double TrafficResult::lockSuccess() const {
  if (tally.locks == 0) return 1.0;
  return 1.0 - static_cast<double>(std::min(findings.size(), tally.locks)) / static_cast<double>(tally.locks);
}

TrafficResult runTraffic(std::shared_ptr<const interval::LockSite> site, std::vector<Way> ways,
                         const interval::LockRules& rules, const TrafficOptions& options,
                         const TrafficWatch& watch) {
  return Traffic(std::move(site), std::move(ways), rules, options, watch).run();
}

}  // namespace pos::traffic
