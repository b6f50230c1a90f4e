#pragma once
/// Random traffic for tests of locks: vehicles that obey what they are allowed, with positions that are
/// noisy, go missing, jump, grow uncertain and raise alarms, and an engine that loses its memory now and
/// then. Truth is kept apart and judged without asking the engine.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "pos/core/random.hpp"
#include "pos/interval/lock_audit.hpp"
#include "pos/interval/lock_engine.hpp"

namespace pos::testing {

struct TrafficOptions {
  std::uint64_t seed = 1;
  int vehicles = 20;
  std::size_t requests = 4000;       ///< no new ways are begun after this many
  double missing_per_s = 1.0 / 300;  ///< a spell without reports, 2 to 40 s
  double jump_per_s = 1.0 / 200;     ///< a wrong place by 10 to 80 m, for 1 to 8 s
  double vague_per_s = 1.0 / 300;    ///< sigma of 2 to 8 m, for 5 to 30 s
  double alarm_per_s = 1.0 / 1000;   ///< for 5 to 20 s
  double restart_per_s = 1.0 / 5000;
};

struct TrafficResult {
  interval::AuditTally tally;
  std::vector<interval::AuditFinding> findings;
  std::size_t opposing = 0;  ///< seconds in which two bodies opposed each other in one section, by truth
  std::size_t deadlocks = 0;
  std::string jam = {};  ///< who waited where for what, at a deadlock
  std::size_t ways_finished = 0;
  double simulated = 0.0;  ///< s
  double driven = 0.0;     ///< m, all vehicles
};

class LockTraffic {
 public:
  LockTraffic(std::shared_ptr<const interval::LockSite> site, std::vector<interval::Way> ways,
              const TrafficOptions& options)
      : site_(std::move(site)),
        ways_(std::move(ways)),
        options_(options),
        random_(options.seed, 77),
        engine_(site_, rules_),
        audit_(site_, rules_) {
    for (int id = 0; id < options_.vehicles; ++id) {
      Vehicle v;
      v.shape = {.vehicle = id,
                 .front = 3.0,
                 .rear = id % 3 == 0 ? 5.0 : 3.0,
                 .max_speed = 7.0,
                 .priority = 1 - id % 2};
      v.cruise = random_.uniform(3.0, 6.5);
      v.sigma = random_.uniform(0.4, 1.4);
      v.depot = ways_[pick(ways_.size())].stops.front().stop;
      v.idle_until = random_.uniform(0.0, 120.0);
      vehicles_.push_back(v);
      tell(v.shape);
    }
  }

  TrafficResult run() {
    double quiet = 0.0;
    while (!finished()) {
      t_ += 1.0;
      const std::size_t granted = audit_.tally().granted;
      maybeRestart();
      for (Vehicle& v : vehicles_) step(v);
      judgeTruth();
      tell(interval::Tick{});
      const bool somebody_waits =
          std::any_of(vehicles_.begin(), vehicles_.end(), [](const Vehicle& v) { return v.asked; });
      quiet = audit_.tally().granted > granted || !somebody_waits ? 0.0 : quiet + 1.0;
      if (quiet > kStuck) {
        ++result_.deadlocks;
        result_.jam = jam();
        break;
      }
    }
    result_.tally = audit_.tally();
    result_.findings = audit_.findings();
    result_.simulated = t_;
    return result_;
  }

 private:
  static constexpr double kStuck = 3000.0;  // s without any grant while somebody waits

  struct Vehicle {
    interval::Enrol shape;
    double cruise = 5.0;
    double sigma = 1.0;
    std::size_t depot = 0;
    double idle_until = 0.0;
    bool has_way = false;
    interval::Way way;
    std::size_t stop = 0;     // it may drive to
    double rear_limit = 0.0;  // what it knows to hold behind
    bool on_road = false;
    bool asked = false;
    double d = 0.0;
    double speed = 0.0;
    double noise = 0.0;  // in sigmas, correlated in time
    double missing_until = 0.0;
    double jump_until = 0.0;
    double jump = 0.0;
    double vague_until = 0.0;
    double vague_sigma = 0.0;
    double alarm_until = 0.0;
    double doubted_since = -1.0;
    double announce_at = -1.0;  // after a restart
  };

  std::size_t pick(std::size_t n) { return random_.bits() % n; }

  bool finished() const {
    return audit_.tally().requests >= options_.requests &&
           std::none_of(vehicles_.begin(), vehicles_.end(), [](const Vehicle& v) { return v.has_way; });
  }

  template <class What>
  void tell(const What& what) {
    const interval::LockEvent event{stampFromSeconds(t_), what};
    const auto records = engine_.take(event);
    audit_.take(event, records);
    for (const interval::LockRecord& record : records) hear(record);
  }

  void hear(const interval::LockRecord& record) {
    using Kind = interval::LockRecord::Kind;
    if (record.vehicle < 0) return;
    Vehicle& v = vehicles_[static_cast<std::size_t>(record.vehicle)];
    if (record.kind == Kind::Granted) {
      const bool off = !v.on_road;
      if (off) v.rear_limit = v.way.stops[v.stop].from;
      while (v.way.stops[v.stop].stop != record.stop) ++v.stop;
      v.on_road = true;
      v.asked = false;
    }
    if (record.kind == Kind::Released) {
      for (const interval::WaySection& s : v.way.sections) {
        if (s.section == record.section && s.to <= v.d + 1.0) v.rear_limit = std::max(v.rear_limit, s.to);
      }
    }
    if (record.kind == Kind::Doubted) v.doubted_since = t_;
    if (record.kind == Kind::Trusted) v.doubted_since = -1.0;
  }

  void maybeRestart() {
    if (!random_.bernoulli(options_.restart_per_s)) return;
    for (const Vehicle& v : vehicles_) {
      if (v.announce_at >= 0.0) return;  // still busy with the last one
    }
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
    drive(v);
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
    std::vector<const interval::Way*> from_here;
    for (const interval::Way& way : ways_) {
      if (way.stops.front().stop == v.depot) from_here.push_back(&way);
    }
    v.way = *from_here[pick(from_here.size())];
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

  /// Distance on v's way that it may go to before it meets the rear of another vehicle.
  double behindOthers(const Vehicle& v) const {
    double limit = 1e9;
    for (const Vehicle& other : vehicles_) {
      if (&other == &v || !other.on_road) continue;
      for (const interval::WaySection& theirs : other.way.sections) {
        if (other.d < theirs.from || other.d >= theirs.to) continue;
        for (const interval::WaySection& mine : v.way.sections) {
          if (mine.section != theirs.section || mine.movement != theirs.movement) continue;
          const double at = mine.from + (other.d - theirs.from);
          const bool ahead = at > v.d || (at == v.d && other.shape.vehicle < v.shape.vehicle);
          if (ahead) limit = std::min(limit, at - other.shape.rear - v.shape.front - 3.0);
        }
      }
    }
    return limit;
  }

  void drive(Vehicle& v) {
    const double target = std::min(v.way.stops[v.stop].at, behindOthers(v));
    const double left = std::max(0.0, target - v.d);
    const double wanted = std::min({v.cruise, v.speed + 0.5, std::sqrt(2.0 * 0.6 * left)});
    const double moved = std::min(left, left < 0.5 ? left : wanted);
    v.speed = moved;
    v.d += moved;
    result_.driven += moved;
  }

  void report(Vehicle& v, double before) {
    const auto spell = [&](double& until, double rate, double shortest, double longest) {
      if (t_ >= until && random_.bernoulli(rate)) until = t_ + random_.uniform(shortest, longest);
    };
    spell(v.missing_until, options_.missing_per_s, 2.0, 40.0);
    spell(v.alarm_until, options_.alarm_per_s, 5.0, 20.0);
    if (t_ >= v.vague_until) v.vague_sigma = random_.uniform(2.0, 8.0);
    spell(v.vague_until, options_.vague_per_s, 5.0, 30.0);
    if (t_ >= v.jump_until) v.jump = random_.uniform(10.0, 80.0) * (random_.bernoulli(0.5) ? 1.0 : -1.0);
    spell(v.jump_until, options_.jump_per_s, 1.0, 8.0);
    v.noise = 0.8 * v.noise + 0.6 * random_.normal();
    if (v.announce_at >= 0.0 || t_ < v.missing_until) return;

    const double sigma = t_ < v.vague_until ? v.vague_sigma : v.sigma;
    interval::Report told{.vehicle = v.shape.vehicle, .distance = v.d + sigma * v.noise, .sigma = sigma};
    told.speed = v.d - before + random_.normal(0.0, 0.2);
    if (t_ < v.jump_until) told.distance += v.jump;
    if (t_ < v.alarm_until) told.integrity = interval::Report::Integrity::Alarm;
    for (const interval::WayStop& stop : v.way.stops) {
      const bool passed = before < stop.at && v.d >= stop.at;
      if (!passed || !random_.bernoulli(0.9)) continue;
      told.evidence = interval::Report::Evidence::Passage;
      told.sigma = 0.4;
      told.distance = v.d + random_.normal(0.0, 0.4);
    }
    if (v.doubted_since >= 0.0 && t_ - v.doubted_since > 240.0) {
      tell(interval::Override{interval::Override::Action::Trust, v.shape.vehicle, "dispatcher",
                              "driver names the place by telephone"});
      told.distance = v.d + random_.normal(0.0, sigma);
      v.jump_until = t_;
    }
    tell(told);
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
  std::string jam() {
    std::string text;
    for (const Vehicle& v : vehicles_) {
      if (!v.has_way) continue;
      const interval::StopPlace& stop = site_->stops[v.way.stops[v.stop].stop];
      text += "vehicle " + std::to_string(v.shape.vehicle) + " at " + std::to_string(v.d) + " m" +
              (v.on_road ? " on the road to " : " parked at ") + stop.id + " at " +
              std::to_string(v.way.stops[v.stop].at) +
              (engine_.view(v.shape.vehicle).believed ? "" : " (not believed)");
      const interval::LockEvent again{stampFromSeconds(t_), interval::Request{v.shape.vehicle}};
      for (const interval::LockRecord& record : engine_.take(again))
        text +=
            "; " + std::string(name(record.kind)) + " " + record.reason + " " + std::to_string(record.other);
      text += "\n";
    }
    return text;
  }

  void judgeTruth() {
    std::map<std::size_t, int> moving;  // by section
    bool opposing = false;
    for (const Vehicle& v : vehicles_) {
      if (!v.on_road) continue;
      for (const interval::WaySection& s : v.way.sections) {
        if (s.to <= v.d - v.shape.rear || s.from >= v.d + v.shape.front) continue;
        const auto [entry, first] = moving.emplace(s.section, s.movement);
        opposing = opposing || (!first && entry->second != s.movement);
      }
    }
    result_.opposing += opposing ? 1 : 0;
  }

  std::shared_ptr<const interval::LockSite> site_;
  std::vector<interval::Way> ways_;
  TrafficOptions options_;
  interval::LockRules rules_ = {};
  RandomStream random_;
  interval::LockEngine engine_;
  interval::LockAudit audit_;
  std::vector<Vehicle> vehicles_;
  TrafficResult result_;
  double t_ = 0.0;
};

}  // namespace pos::testing
