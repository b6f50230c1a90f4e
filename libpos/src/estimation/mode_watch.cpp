#include "pos/estimation/mode_watch.hpp"

#include <algorithm>

namespace pos::estimation {
namespace {

/// Before two epochs were heard, and the longest interval that is learnt from.
constexpr Duration kLongest = std::chrono::milliseconds(1500);

}  // namespace

Stamp ModeWatch::due() const {
  const auto known = intervals_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, intervals_.size()));
  const Duration period = count_ == 0 ? kLongest : *std::max_element(intervals_.begin(), known);
  return *last_heard_ + period;
}

void ModeWatch::heard(Stamp stamp) {
  if (last_heard_ && stamp > *last_heard_ && stamp - *last_heard_ <= kLongest)
    intervals_[count_++ % intervals_.size()] = stamp - *last_heard_;
  last_heard_ = stamp;
}

void ModeWatch::leave(Stamp since) {
  usable_ = false;
  since_ = since;
  rejected_ = 0;
  first_rejected_.reset();
}

bool ModeWatch::applied(Stamp stamp) {
  if (!usable_ && last_heard_ && stamp > due() + durationFromSeconds(config_.overdue)) {
    count_ = 0;  // it was away: the gap is no period
    last_heard_.reset();
  }
  heard(stamp);
  last_applied_ = stamp;
  rejected_ = 0;
  first_rejected_.reset();
  if (usable_) return false;
  usable_ = true;
  since_ = stamp;
  return true;
}

bool ModeWatch::rejected(Stamp stamp) {
  if (!usable_) return false;
  heard(stamp);
  if (!first_rejected_) first_rejected_ = stamp;
  if (++rejected_ < config_.rejected_in_a_row) return false;
  leave(*first_rejected_);
  return true;
}

bool ModeWatch::advanced(Stamp now) {
  if (!usable_ || now <= due() + durationFromSeconds(config_.overdue)) return false;
  leave(due());
  return true;
}

}  // namespace pos::estimation
