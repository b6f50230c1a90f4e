#pragma once
/// One double-sided two-way ranging exchange between an initiator A (tag) and a responder B (anchor).
///
/// A sends the poll at T1, B hears it at T2 and answers at T3, A hears that at T4 and sends the final message
/// at T5, B hears it at T6. Spec A section 2.1; errata A1 (sign) and A2 (clock law).

#include <array>
#include <cstdint>
#include <string>

#include "pos/core/random.hpp"

namespace pos::sim {

constexpr double kSpeedOfLight = 299792458.0;  ///< m/s

/// A radio's clock: it shows offset + (1 + rate_error) t at true time t.
struct RadioClock {
  double rate_error = 0.0;     ///< -, 20e-6 = 20 ppm fast
  double offset = 0.0;         ///< s
  double antenna_delay = 0.0;  ///< s, between antenna and time stamp, each way
};

/// How the exchange is run. Defaults are those of a DW1000-like radio.
struct TwoWayConfig {
  double tick = 15.65e-12;        ///< s of the radio's own clock per count
  int counter_bits = 40;          ///< the counter wraps at 2^bits
  double reply_responder = 1e-3;  ///< s of B's clock from T2 to T3, at most 40 ms
  double reply_initiator = 1e-3;  ///< s of A's clock from T4 to T5, at most 40 ms
  double receive_jitter = 0.0;    ///< s, 1 sigma of each receive stamp (T2, T4, T6)
};

/// Throws ConfigError naming `key` and the first field that cannot be.
TwoWayConfig validated(TwoWayConfig config, const std::string& key);

/// What the six stamps would read with an endless, stepless counter: s of each radio's own clock.
/// A: t[0], t[3], t[4]; B: t[1], t[2], t[5].
struct TwoWayTimes {
  std::array<long double, 6> t = {};
};

/// The six stamps as the radios give them: counts modulo 2^counter_bits.
struct TwoWayStamps {
  std::array<std::int64_t, 6> count = {};
};

/// One exchange whose poll starts at true time `begin` (s). `flights` are the path lengths (m) of poll,
/// answer and final message: equal at rest.
TwoWayTimes exchange(double begin, const std::array<double, 3>& flights, const RadioClock& a,
                     const RadioClock& b, const TwoWayConfig& config, RandomStream& random);

/// Rounded down to counts, and wrapped.
TwoWayStamps counted(const TwoWayTimes& times, const TwoWayConfig& config);

/// T = (R1 R2 - D1 D2) / (R1 + R2 + D1 + D2), s, antenna delays still inside.
double flightTime(const TwoWayTimes& times);
/// The same from counts, across a wrap of either counter.
double flightTime(const TwoWayStamps& stamps, const TwoWayConfig& config);

/// Nominal true length of an exchange over `distance` m, s: from the poll's start to the final's arrival.
double exchangeDuration(const TwoWayConfig& config, double distance);

}  // namespace pos::sim
