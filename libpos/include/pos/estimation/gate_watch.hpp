#pragma once
/// Keeps a gate from locking the filter out: notices when a gate rejects nearly everything for a while.

#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "pos/core/measurement.hpp"
#include "pos/core/verdict.hpp"
#include "pos/estimation/configs.hpp"

namespace pos::estimation {

/// Watches which anchors agree with the filter. One anchor that disagrees while others agree is that anchor's
/// trouble (rock in the line of sight); when most disagree, it is the filter that is lost.
class GateWatch {
 public:
  explicit GateWatch(const GateConfig& config) : config_(config) {}

  /// Notes one range that was Applied or Gated. True when the gate must open now: for `open_after` seconds
  /// fewer than `agreement_fraction` of the anchors heard had a range that passed (three times as long while
  /// only one anchor is heard, since then nothing tells a lost filter from a bad range).
  bool opens(Stamp stamp, AnchorId anchor, Verdict verdict);

  /// How often the gate opened since the last agreement.
  int openings() const { return openings_; }
  void forget();

 private:
  struct Heard {
    Stamp stamp;
    AnchorId anchor;
    bool passed;
  };
  struct Tally {
    int heard = 0;
    int passed = 0;
  };
  void note(const Heard& heard);
  void dropOlderThan(Stamp stamp);
  bool agreement() const;

  GateConfig config_;
  std::deque<Heard> window_;           // the last `open_after` seconds
  std::map<AnchorId, Tally> tallies_;  // of the window, kept as it moves
  std::optional<Stamp> disagreeing_since_;
  int rejected_ = 0;
  int openings_ = 0;
};

}  // namespace pos::estimation
