#pragma once
/// What is going on, as one picture for every screen. JSON: docs/formats/serve.md.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/estimate.hpp"
#include "pos/core/verdict.hpp"
#include "pos/interval/interval_tracker.hpp"
#include "pos/map/lock_intervals.hpp"
#include "pos/map/tunnel_map.hpp"
#include "pos/serve/connections.hpp"

namespace pos::serve {

enum class Mode { Run, Replay, Live, Map };
std::string_view name(Mode mode);

/// What one estimator says at one moment.
struct EstimatorState {
  std::string name = {};
  std::string type = {};
  std::optional<Estimate> estimate = {};
  std::optional<double> error = {};  ///< m, in plan
  std::optional<double> nis = {};    ///< per degree of freedom, of the last tested reading
  std::array<std::uint64_t, kVerdicts.size()> verdicts = {};
  Diagnostics modes = {};  ///< probability of each motion model; empty where there is only one
  std::optional<interval::IntervalBelief> place = {};
};

/// Values named "probability_<model>" among the diagnostics, named by the model.
Diagnostics modesOf(const Diagnostics& diagnostics);

/// State of a lock interval. Doubtful: the vehicle may be in it, or its position is not believed; to be
/// treated as occupied.
enum class Occupancy { Unknown, Free, Doubtful, Held };
std::string_view name(Occupancy occupancy);

struct Recording {
  bool on = false;
  std::string file = {};  ///< without its folder
  std::uint64_t measurements = 0;
  std::uint64_t bytes = 0;
};

struct Show {
  Mode mode = Mode::Run;
  bool playing = false;
  bool seeking = false;
  bool ended = false;
  double speed = 1.0;
  std::optional<Stamp> stamp = {};
  std::optional<Stamp> first = {};
  std::optional<Stamp> last = {};
  std::optional<Pose3> truth = {};
  std::vector<EstimatorState> estimators = {};
  std::vector<Occupancy> locks =
      {};  ///< of every interval; empty: what the first estimator's place makes of them
  Connections connections = {};
  std::optional<Recording> recording = {};
  std::uint64_t refused_lines = 0;
};

/// The names that numbers in the state stand for.
struct Names {
  std::vector<std::string> roadways = {};
  std::vector<map::LockInterval> intervals = {};
};

/// What a lock would have to make of a vehicle that may be in it with this probability.
Occupancy occupancy(const interval::IntervalBelief& belief, std::size_t interval);

/// "R12, 345.2 m, interval j_2, lock held". `locks` holds the state of every interval; empty where only the
/// belief tells.
std::string words(const interval::IntervalBelief& belief, const Names& names,
                  const std::vector<Occupancy>& locks = {});

/// The state without `seq`: two are equal exactly when nothing changed.
std::string stateBody(const Show& show, const Names& names);
/// With it.
std::string withSeq(std::uint64_t seq, const std::string& body);

/// `{"intervals": [...]}`.
std::string intervalsJson(const Names& names);

}  // namespace pos::serve
