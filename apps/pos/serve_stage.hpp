#pragma once
/// What browsers look at: one thread puts it there, any number of threads read it.

#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "inputs.hpp"
#include "lock_watch.hpp"
#include "pos/eval/path_tangent.hpp"
#include "pos/serve/event_log.hpp"
#include "pos/serve/state.hpp"
#include "pos/serve/track.hpp"

namespace pos::app {

/// Truth, and which way it moves.
class Reference {
 public:
  /// Truth is not interpolated over more than `max_gap`.
  Reference(const Truth& truth, Duration max_gap)
      : truth_(truth), max_gap_(max_gap), tangent_(truth, {.max_truth_gap = max_gap}) {}
  const Truth& truth() const { return truth_; }
  std::optional<Pose3> at(Stamp stamp) const;
  void compare(serve::TrackRow& row) const;

 private:
  Truth truth_;
  Duration max_gap_;
  eval::PathTangent tangent_;
};

/// What does not change while the server runs.
struct Scenery {
  serve::Mode mode = serve::Mode::Run;
  std::string name = {};
  std::string map_name = {};
  struct Title {
    std::string name;
    std::string type;
  };
  std::vector<Title> estimators = {};
  serve::Names names = {};
  std::vector<AnchorId> anchors = {};
  std::optional<map::Network> network = {};  ///< where the map has roadways
  std::optional<Reference> reference = {};
  bool intervals = false;                         ///< each estimator's place is told
  std::shared_ptr<const LockedRoute> locks = {};  ///< null where locks are judged by the place alone
};
/// With the locks along a route where a vehicle is given. Throws ConfigError for a route that cannot be
/// locked.
Scenery sceneryOf(const Inputs& inputs, serve::Mode mode, const std::optional<LockedVehicle>& vehicle = {});

class Stage {
 public:
  explicit Stage(Scenery scenery);

  const Scenery& scenery() const { return scenery_; }
  static constexpr std::string_view kTruth = "truth";

  // ---- for the thread that plays
  /// Back to before the first measurement.
  void clear();
  void verdict(std::size_t estimator, const Measurement& measurement, const IngestReport& report);
  void estimate(std::size_t estimator, const Estimate& estimate,
                const std::optional<interval::IntervalBelief>& belief);
  void modes(std::size_t estimator, Diagnostics modes);
  void truth(const TruthPose& pose);
  void event(io::RunEvent event);
  void setSpan(std::optional<Stamp> first, std::optional<Stamp> last);

  // ---- for everybody
  std::vector<serve::EstimatorState> estimators() const;
  /// State of every interval; none while nothing is known.
  std::vector<serve::Occupancy> locks() const;
  std::vector<serve::Occupancy> locksAt(Stamp stamp) const;
  /// `[{"stamp_s", "states": [...]}]`, every change.
  std::string lockChangesJson() const;
  std::optional<Pose3> truthAt(Stamp stamp) const;
  std::optional<Stamp> first() const;
  std::optional<Stamp> last() const;
  std::uint64_t events() const;
  std::string eventsJson(std::uint64_t after, std::size_t limit) const;
  std::string tracksJson() const;
  /// Throws RequestError for a track that is not there.
  std::string packed(const std::string& track, const serve::TrackWindow& window) const;
  /// Grows with every change.
  std::uint64_t resets() const;

 private:
  /// From here on.
  struct LockChange {
    Stamp stamp = {};
    std::vector<serve::Occupancy> states = {};
  };
  /// Since the row before.
  struct Tested {
    double nis = 0.0;
    int tested = 0;
    int gated = 0;
  };
  void locate(serve::TrackRow& row, const Eigen::Vector3d& p_map) const;
  std::size_t trackOf(const std::string& name) const;
  std::vector<serve::Occupancy> lockStates(const Estimate& estimate,
                                           const std::optional<interval::IntervalBelief>& belief);

  const Scenery scenery_;
  std::optional<LockWatch> watch_;  ///< of the thread that plays alone
  mutable std::shared_mutex mutex_;
  std::vector<serve::EstimatorState> states_;
  std::vector<Tested> tested_;
  std::vector<serve::Track> tracks_;  ///< of the estimators, then of the truth
  std::vector<LockChange> locks_;
  serve::EventLog events_;
  std::optional<Stamp> first_;
  std::optional<Stamp> last_;
  std::uint64_t resets_ = 0;
};

}  // namespace pos::app
