#pragma once
/// One road with one lane between two depots, with niches in between: the smallest site for tests of locks.

#include <memory>
#include <string>
#include <vector>

#include "pos/interval/lock_engine.hpp"

namespace pos::testing {

/// Blocks of 100 m and bays of 40 m in turn: section 0 is block 0, section 1 bay 0, section 2 block 1, ...
/// Stop 0 is the depot at the start, stop 1 the one at the end, stop 2 + i the niche at bay i, in its middle.
struct LockLine {
  explicit LockLine(std::size_t niches, int capacity = 1) {
    site->stops = {{"west", interval::StopPlace::Kind::Depot}, {"east", interval::StopPlace::Kind::Depot}};
    double at = 0.0;
    east.stops.push_back({0, 0.0, 0.0, 0.0});
    for (std::size_t i = 0; i <= niches; ++i) {
      at = add("block " + std::to_string(i), at, 100.0);
      if (i == niches) break;
      east.stops.push_back({site->stops.size(), at + 20.0, at + 12.0, at + 28.0});
      site->stops.push_back(
          {"N" + std::to_string(i), interval::StopPlace::Kind::Niche, 10.0 * capacity, capacity});
      at = add("bay " + std::to_string(i), at, 40.0);
    }
    east.stops.push_back({1, at, at, at});
    west = reversed(east, at);
  }

  std::shared_ptr<interval::LockSite> site = std::make_shared<interval::LockSite>();
  interval::Way east;  ///< from stop 0 to stop 1
  interval::Way west;

 private:
  double add(const std::string& id, double at, double length) {
    east.sections.push_back({site->sections.size(), 1, at, at + length});
    site->sections.push_back({id});
    return at + length;
  }
  static interval::Way reversed(const interval::Way& way, double length) {
    interval::Way back;
    for (auto s = way.sections.rbegin(); s != way.sections.rend(); ++s)
      back.sections.push_back({s->section, -s->movement, length - s->to, length - s->from});
    for (auto s = way.stops.rbegin(); s != way.stops.rend(); ++s)
      back.stops.push_back({s->stop, length - s->at, length - s->to, length - s->from});
    return back;
  }
};

}  // namespace pos::testing
