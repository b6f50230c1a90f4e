#pragma once
/// Tells a hidden anchor from a lost filter by who rejects whom.

#include <optional>
#include <vector>

#include "pos/core/stamp.hpp"
#include "pos/core/verdict.hpp"
#include "pos/estimation/configs.hpp"

namespace pos::estimation {

/// One anchor that is rejected several times in a row is taken to be hidden (rock, another vehicle) and left
/// alone for a while. When most anchors are rejected or left alone for some time, it is the filter that is
/// lost.
class AnchorWatch {
 public:
  AnchorWatch(const SightConfig& config, int anchors)
      : config_(config), anchors_(static_cast<std::size_t>(anchors)) {}

  enum class Finding { None, Blocked, Lost };

  /// The anchor is being left alone.
  bool blocked(int anchor, Stamp stamp) const;
  /// Notes what became of a range: tested and Applied or Gated, or (`tested` absent) not tested for being
  /// blocked.
  Finding note(int anchor, Stamp stamp, std::optional<Verdict> tested);
  void forget();
  struct Heard {
    int anchors = 0;      ///< hidden ones among them
    int disagreeing = 0;  ///< of those, rejected when last tested
  };
  /// Within `restart_after` before the stamp.
  Heard heardLately(Stamp stamp) const;

 private:
  struct State {
    std::optional<Stamp> heard;
    std::optional<Stamp> blocked_until;
    int rejections = 0;  // in a row
    bool agrees = true;
  };
  bool agreement(Stamp stamp) const;

  SightConfig config_;
  std::vector<State> anchors_;
  std::optional<Stamp> disagreeing_since_;
};

}  // namespace pos::estimation
