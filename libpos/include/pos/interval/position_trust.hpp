#pragma once
/// Whether a vehicle's reported positions can be believed.

#include <optional>

#include "pos/core/stamp.hpp"
#include "pos/interval/lock_events.hpp"
#include "pos/interval/lock_rules.hpp"

namespace pos::interval {

/// A position along a way with its sigma, m.
struct TrackPoint {
  Stamp stamp = {};
  double distance = 0.0;
  double sigma = 0.0;
};

/// Reports are compared with a track that is dead reckoned from the told speeds and taken over by every
/// report that is better than it; the two are not averaged, since reports err alike for a while. A report
/// that the track excludes begins a doubt, which ends when a report agrees with the track again, while that
/// is still good for anything, or by a passage. After a gap, and after a step that only a poor track allows,
/// reports have to be steady for a time. A position that jumped and stays there is never believed for its
/// steadiness.
class PositionTrust {
 public:
  PositionTrust(const LockRules& rules, double max_speed) : rules_(rules), max_speed_(max_speed) {}

  /// `speed` (m/s) is what the wheels say of the time since the last report; without it anything up to the
  /// top speed is possible.
  void take(const TrackPoint& now, std::optional<double> speed, Report::Evidence evidence);
  /// Whatever came before, the next report is believed (the vehicle was seen).
  void forget();
  /// It was certainly there.
  void prove(const TrackPoint& place);
  /// Nothing is known of the past: reports have to be steady first.
  void lose();
  bool trusted() const { return state_ == State::Trusted; }
  /// The belief at the newest report that was believed; nothing before the first.
  const std::optional<TrackPoint>& believed() const { return believed_; }

 private:
  enum class State { Trusted, AfterGap, AfterJump };
  void weigh(const TrackPoint& now, std::optional<double> speed);
  void restart(const TrackPoint& now);
  void adopt(const TrackPoint& now);

  LockRules rules_;
  double max_speed_ = 0.0;
  State state_ = State::Trusted;
  std::optional<TrackPoint> track_;  // dead reckoned since the last good report
  std::optional<TrackPoint> believed_;
  Stamp steady_since_ = {};
};

}  // namespace pos::interval
