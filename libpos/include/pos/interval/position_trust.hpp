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

/// Doubts begin with a step that no vehicle can make, or with a gap. They end by a passage, by reports that
/// come back to where the steps before and after the jump lead, or, after a gap only, by steady reports. A
/// position that jumped and stays there is never believed for its steadiness.
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
  bool trusted() const { return trusted_; }
  /// The newest believed report; nothing before the first.
  const std::optional<TrackPoint>& believed() const { return believed_; }

 private:
  enum class Gap { No, Yes };  // no report for longer than rules_.stale_after
  /// What a step may have been: about `expected`, give or take `slack`, m.
  struct Step {
    double expected = 0.0;
    double slack = 0.0;
  };
  Step possible(double dt, std::optional<double> speed) const;
  bool plausible(const TrackPoint& now, const Step& step) const;
  void doubt(const TrackPoint& now, const Step& step, Gap gap);
  void weigh(const TrackPoint& now, const Step& step, Gap gap);
  bool back(const TrackPoint& now) const;

  LockRules rules_;
  double max_speed_ = 0.0;
  bool trusted_ = true;
  std::optional<TrackPoint> last_;
  std::optional<TrackPoint> believed_;
  std::optional<TrackPoint> anchor_;  // last believed report before a jump; nothing after a gap
  double carried_ = 0.0;              // m, steps since the anchor, impossible ones replaced by the expected
  double slack_ = 0.0;                // m, how wrong the replaced steps may be
  Stamp steady_since_ = {};
};

}  // namespace pos::interval
