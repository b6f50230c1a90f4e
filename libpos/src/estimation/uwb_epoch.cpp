#include "pos/estimation/uwb_epoch.hpp"

#include <cmath>

namespace pos::estimation {

Stamp UwbEpoch::middle() const {
  Duration sum{0};
  for (int i = 0; i < count_; ++i) sum += stamps_[static_cast<std::size_t>(i)] - stamps_[0];
  return stamps_[0] + sum / std::max(count_, 1);
}

bool UwbEpoch::holds(const UwbReading& reading) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
    if (tags_[i] == reading.tag && anchors_[i] == reading.anchor) return true;
  }
  return false;
}

bool UwbEpoch::add(Stamp stamp, const UwbReading& reading) {
  int kept = 0;  // the link's older range goes
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
    if (tags_[i] == reading.tag && anchors_[i] == reading.anchor) continue;
    const auto k = static_cast<std::size_t>(kept++);
    ranges_[k] = ranges_[i];
    stamps_[k] = stamps_[i];
    tags_[k] = tags_[i];
    anchors_[k] = anchors_[i];
  }
  count_ = kept;
  if (count_ == uwb::kMaxRanges) return false;
  const auto k = static_cast<std::size_t>(count_++);
  ranges_[k] = reading.range;
  stamps_[k] = stamp;
  tags_[k] = reading.tag;
  anchors_[k] = reading.anchor;
  return true;
}

void UwbEpoch::dropBefore(Stamp stamp) {
  int kept = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
    if (stamps_[i] < stamp) continue;
    const auto k = static_cast<std::size_t>(kept++);
    ranges_[k] = ranges_[i];
    stamps_[k] = stamps_[i];
    tags_[k] = tags_[i];
    anchors_[k] = anchors_[i];
  }
  count_ = kept;
}

std::array<uwb::BodyRange, uwb::kMaxRanges> UwbEpoch::agedRanges(Stamp now, double speed) const {
  std::array<uwb::BodyRange, uwb::kMaxRanges> aged = ranges_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) {
    aged[i].sigma = std::hypot(aged[i].sigma, speed * seconds(now - stamps_[i]));
  }
  return aged;
}

}  // namespace pos::estimation
