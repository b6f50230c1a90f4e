#pragma once
/// Events of a run with numbers, so that a browser can ask for what it has not seen.

#include <cstdint>
#include <deque>
#include <string>

#include "pos/io/run_folder.hpp"

namespace pos::serve {

/// One event as JSON text.
std::string eventJson(std::uint64_t n, const io::RunEvent& event);

class EventLog {
 public:
  /// Kept at most; the oldest go first and their numbers with them.
  static constexpr std::size_t kMost = 100'000;

  void add(io::RunEvent event);
  void clear();
  std::uint64_t total() const { return first_ + events_.size(); }
  /// `{"events": [...], "total": n}` with those from number `after` on, at most `limit`.
  std::string json(std::uint64_t after, std::size_t limit) const;

 private:
  std::deque<io::RunEvent> events_;
  std::uint64_t first_ = 0;
};

}  // namespace pos::serve
