#pragma once
/// Time in the library: nanosecond stamps read from the data, never from the wall clock.

#include <chrono>
#include <cmath>
#include <cstdint>

namespace pos {

/// Signed nanoseconds.
using Duration = std::chrono::duration<std::int64_t, std::nano>;

/// The clock of the recording. It cannot be asked for "now": stamps come from measurements only.
struct LogClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<LogClock, duration>;
  static constexpr bool is_steady = true;
};

/// A moment, nanoseconds since 1970-01-01 UTC (or since the log's own origin where it has no calendar).
using Stamp = LogClock::time_point;

/// Seconds of a duration, for use inside one model step.
constexpr double seconds(Duration d) {
  return 1e-9 * static_cast<double>(d.count());
}

/// Duration nearest to `s` seconds. |s| < 9.2e9.
inline Duration durationFromSeconds(double s) {
  return Duration{std::llround(s * 1e9)};
}

/// Seconds since the clock's origin. Exact to about 0.2 us for present-day calendar stamps.
constexpr double secondsSinceOrigin(Stamp t) {
  return seconds(t.time_since_epoch());
}

inline Stamp stampFromSeconds(double s) {
  return Stamp{durationFromSeconds(s)};
}

}  // namespace pos
