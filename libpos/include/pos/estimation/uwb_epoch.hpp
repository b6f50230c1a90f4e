#pragma once
/// Ranges that belong together: one of each link, taken within a short time.

#include <array>
#include <optional>
#include <span>

#include "pos/core/stamp.hpp"
#include "pos/estimation/uwb_links.hpp"

namespace pos::estimation {

class UwbEpoch {
 public:
  bool empty() const { return count_ == 0; }
  int size() const { return count_; }
  /// Mean of the stamps; the moment that a fix of these ranges tells of.
  Stamp middle() const;
  Stamp first() const { return stamps_[0]; }

  bool holds(const UwbReading& reading) const;
  /// False when there is no room. A link that is there already is replaced.
  bool add(Stamp stamp, const UwbReading& reading);
  /// Drops what is older.
  void dropBefore(Stamp stamp);
  void clear() { count_ = 0; }

  std::span<const uwb::BodyRange> ranges() const {
    return {ranges_.data(), static_cast<std::size_t>(count_)};
  }
  /// The same, less sure by what the vehicle may have moved since each was taken.
  std::array<uwb::BodyRange, uwb::kMaxRanges> agedRanges(Stamp now, double speed) const;

 private:
  std::array<uwb::BodyRange, uwb::kMaxRanges> ranges_{};
  std::array<Stamp, uwb::kMaxRanges> stamps_{};
  std::array<int, uwb::kMaxRanges> tags_{};
  std::array<int, uwb::kMaxRanges> anchors_{};
  int count_ = 0;
};

}  // namespace pos::estimation
