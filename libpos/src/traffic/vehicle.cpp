#include "vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace pos::traffic {

using interval::WaySection;
using interval::WayStop;

Vehicle newVehicle(int id, const std::vector<interval::Way>& ways, RandomStream& random) {
  Vehicle v;
  v.shape = {
      .vehicle = id, .front = 3.0, .rear = id % 3 == 0 ? 5.0 : 3.0, .max_speed = 7.0, .priority = 1 - id % 2};
  v.cruise = random.uniform(3.0, 6.5);
  v.sigma = random.uniform(0.4, 1.4);
  v.depot = ways[random.bits() % ways.size()].stops.front().stop;
  v.idle_until = random.uniform(0.0, 120.0);
  return v;
}

void hear(Vehicle& v, const interval::LockRecord& record, double t) {
  using Kind = interval::LockRecord::Kind;
  if (record.kind == Kind::Granted) {
    if (!v.on_road) v.rear_limit = v.way.stops[v.stop].from;
    while (v.way.stops[v.stop].stop != record.stop) ++v.stop;
    v.on_road = true;
    v.asked = false;
  }
  if (record.kind == Kind::Released) {
    for (const WaySection& s : v.way.sections) {
      if (s.section == record.section && s.to <= v.d + 1.0) v.rear_limit = std::max(v.rear_limit, s.to);
    }
  }
  if (record.kind == Kind::Doubted) v.doubted_since = t;
  if (record.kind == Kind::Trusted) v.doubted_since = -1.0;
}

namespace {

/// Distance on v's way that it may go to before it meets the rear of another vehicle.
double behindOthers(const Vehicle& v, const std::vector<Vehicle>& all) {
  double limit = 1e9;
  for (const Vehicle& other : all) {
    if (&other == &v || !other.on_road) continue;
    for (const WaySection& theirs : other.way.sections) {
      if (other.d < theirs.from || other.d >= theirs.to) continue;
      for (const WaySection& mine : v.way.sections) {
        if (mine.section != theirs.section || mine.movement != theirs.movement) continue;
        const double at = mine.from + (other.d - theirs.from);
        const bool ahead = at > v.d || (at == v.d && other.shape.vehicle < v.shape.vehicle);
        if (ahead) limit = std::min(limit, at - other.shape.rear - v.shape.front - 3.0);
      }
    }
  }
  return limit;
}

/// Begins and ends the spells in which its positions are bad.
void passTime(Vehicle& v, double t, const TrafficOptions& options, RandomStream& random) {
  const auto spell = [&](double& until, double rate, double shortest, double longest) {
    if (t >= until && random.bernoulli(rate)) until = t + random.uniform(shortest, longest);
  };
  spell(v.missing_until, options.missing_per_s, 2.0, 40.0);
  spell(v.alarm_until, options.alarm_per_s, 5.0, 20.0);
  if (t >= v.vague_until) v.vague_sigma = random.uniform(2.0, 8.0);
  spell(v.vague_until, options.vague_per_s, 5.0, 30.0);
  if (t >= v.jump_until) v.jump = random.uniform(10.0, 80.0) * (random.bernoulli(0.5) ? 1.0 : -1.0);
  spell(v.jump_until, options.jump_per_s, 1.0, 8.0);
  v.noise = 0.8 * v.noise + 0.6 * random.normal();
}

}  // namespace

double drive(Vehicle& v, const std::vector<Vehicle>& all) {
  const double target = std::min(v.way.stops[v.stop].at, behindOthers(v, all));
  const double left = std::max(0.0, target - v.d);
  const double wanted = std::min({v.cruise, v.speed + 0.5, std::sqrt(2.0 * 0.6 * left)});
  const double moved = std::min(left, left < 0.5 ? left : wanted);
  v.speed = moved;
  v.d += moved;
  return moved;
}

std::optional<interval::Report> position(Vehicle& v, double before, double t, const TrafficOptions& options,
                                         RandomStream& random) {
  passTime(v, t, options, random);
  if (v.announce_at >= 0.0 || t < v.missing_until) return std::nullopt;
  const double sigma = t < v.vague_until ? v.vague_sigma : v.sigma;
  interval::Report told{.vehicle = v.shape.vehicle, .distance = v.d + sigma * v.noise, .sigma = sigma};
  told.speed = v.d - before + random.normal(0.0, 0.2);
  if (t < v.jump_until) told.distance += v.jump;
  if (t < v.alarm_until) told.integrity = interval::Report::Integrity::Alarm;
  for (const WayStop& stop : v.way.stops) {
    const bool passed = before < stop.at && v.d >= stop.at;
    if (!passed || !random.bernoulli(0.9)) continue;
    told.evidence = interval::Report::Evidence::Passage;
    told.sigma = 0.4;
    told.distance = v.d + random.normal(0.0, 0.4);
  }
  return told;
}

bool anyOpposing(const std::vector<Vehicle>& all) {
  std::map<std::size_t, int> moving;  // by section
  bool opposing = false;
  for (const Vehicle& v : all) {
    if (!v.on_road) continue;
    for (const WaySection& s : v.way.sections) {
      if (s.to <= v.d - v.shape.rear || s.from >= v.d + v.shape.front) continue;
      const auto [entry, first] = moving.emplace(s.section, s.movement);
      opposing = opposing || (!first && entry->second != s.movement);
    }
  }
  return opposing;
}

}  // namespace pos::traffic
