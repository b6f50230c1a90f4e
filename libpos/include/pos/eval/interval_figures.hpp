#pragma once
/// How well the lock intervals were named: what an interval tracker said against the truth.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pos/eval/association.hpp"
#include "pos/map/lock_intervals.hpp"

namespace pos::eval {

/// The answer at one recorded estimate.
struct IntervalSample {
  Stamp stamp = {};
  bool matched = false;                    ///< a roadway is known
  map::TunnelPoint point = {};             ///< most probable place
  double along_sigma = 0.0;                ///< m
  std::vector<std::size_t> named = {};     ///< intervals at least half probable, ascending
  std::optional<double> boundary_in = {};  ///< s, predicted time to the next boundary
};

/// A stay in an interval, as it was told.
struct IntervalVisit {
  std::size_t interval = 0;
  Stamp entered = {};
  double entered_sigma = 0.0;  ///< s
  std::optional<Stamp> left = {};
};

/// What was recorded of one estimator.
struct IntervalRecord {
  std::vector<IntervalSample> samples = {};  ///< in time order
  std::vector<IntervalVisit> visits = {};    ///< in the order in which they were told
  std::uint64_t entries = 0;
  std::uint64_t exits = 0;
  std::uint64_t branches = 0;          ///< decided
  double branch_past = 0.0;            ///< m, farthest past a junction before its branch was decided
  std::uint64_t lost = 0;              ///< times
  std::uint64_t passages_refused = 0;  ///< chamber passages that were checked and not believed
};

/// The roads and their division, for truth and drawing.
struct IntervalScene {
  map::Network network;
  std::vector<map::LockInterval> intervals;
};

struct IntervalFigures {
  IntervalRecord record;
  std::size_t judged = 0;        ///< samples with a truth on a roadway
  std::size_t right = 0;         ///< of these, with exactly the right set
  std::size_t judged_clear = 0;  ///< samples farther than 3 sigma from every boundary, by truth
  std::size_t right_clear = 0;
  std::size_t entries_matched = 0;  ///< entries whose true moment is known
  double entry_time_rmse = 0.0;     ///< s
  double matched_share = 0.0;       ///< samples with a roadway, of all

  /// 0..1; nothing without truth.
  std::optional<double> rightShare() const;
  std::optional<double> rightShareClear() const;
  std::optional<double> entryTimeRmse() const;
};

/// Where the truth is on the roads: the roadway whose centreline is nearest among those that hold the point;
/// nothing where none does. `lane` follows the heading where there are two lanes.
struct TrueInterval {
  map::RoadwayIndex roadway = 0;
  double chainage = 0.0;
  std::vector<std::size_t> intervals = {};  ///< ascending
};
std::optional<TrueInterval> trueInterval(const IntervalScene& scene, const Pose3& T_map_body, bool has_z);

/// `truth` may be null: the figures against it stay empty.
IntervalFigures intervalFigures(IntervalRecord record, const IntervalScene& scene, const Truth* truth,
                                const AssociationOptions& association);

}  // namespace pos::eval
