#pragma once
/// Whether a mode of a switching estimator can be used: its sensor speaks, and is believed (section A6.2 of
/// the specification).

#include <array>
#include <cstddef>
#include <optional>

#include "pos/core/stamp.hpp"

namespace pos::estimation {

/// What the watch needs to know; s.
struct ModeWatchConfig {
  double overdue = 0.005;  ///< after a reading was due
  int rejected_in_a_row = 3;
};

/// Follows the epochs of one sensor. Its period is learnt: the longest of the last four intervals.
class ModeWatch {
 public:
  explicit ModeWatch(const ModeWatchConfig& config) : config_(config) {}

  bool usable() const { return usable_; }
  /// T1 of the last change of `usable`.
  Stamp since() const { return since_; }
  const std::optional<Stamp>& lastApplied() const { return last_applied_; }

  /// An epoch of which at least one reading was taken. True when the mode joins by it.
  bool applied(Stamp stamp);
  /// An epoch of nothing but rejected readings. True when the mode leaves by it.
  bool rejected(Stamp stamp);
  /// Time goes on. True when the mode leaves because its sensor is silent.
  bool advanced(Stamp now);

 private:
  void heard(Stamp stamp);
  void leave(Stamp since);
  /// When the next epoch is due.
  Stamp due() const;

  ModeWatchConfig config_;
  bool usable_ = false;
  Stamp since_ = {};
  std::optional<Stamp> last_applied_;
  std::optional<Stamp> last_heard_;
  std::optional<Stamp> first_rejected_;
  int rejected_ = 0;
  std::array<Duration, 4> intervals_ = {};
  std::size_t count_ = 0;
};

}  // namespace pos::estimation
