#pragma once
/// Which sensors are heard: connected, stale or lost, by source and by anchor (spec B section A9).
///
/// Threads may ask and tell at the same time. The lock inside is held for the look-up of one name alone,
/// never while an estimator works, so the ages stay true when everything else hangs.

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/core/verdict.hpp"

namespace pos::serve {

struct ConnectionRules {
  /// s without a reading, or three usual periods if that is longer. With the state told every 0.05 s and a
  /// frame of the screen, what falls silent is seen to be stale within a second.
  double stale_after = 0.8;
  double lost_after = 5.0;  ///< s, or fifteen usual periods
};
ConnectionRules validated(ConnectionRules rules);

enum class Connection {
  Waiting,  ///< nothing yet
  Connected,
  Stale,
  Lost,
  Invalid,  ///< the last reading was refused
  Event     ///< comes when something happens; not watched
};
std::string_view name(Connection connection);

/// One source or anchor at one moment.
struct Link {
  Connection state = Connection::Waiting;
  std::optional<double> age = {};     ///< s since the last reading
  std::optional<double> period = {};  ///< s, median of the last five intervals
  std::uint64_t count = 0;
  std::uint64_t refused = 0;
  std::string why = {};                     ///< of the last refusal
  std::optional<double> gated_ratio = {};   ///< of the readings tested in the last 10 s
  std::optional<Verdict> last_tested = {};  ///< Applied or Gated
};
struct SourceLink {
  std::string name = {};
  std::string kind = {};  ///< readingName
  Link link = {};
};
struct AnchorLink {
  AnchorId id = 0;
  Link link = {};
};
struct Connections {
  std::vector<SourceLink> sources = {};  ///< by name
  std::vector<AnchorLink> anchors = {};  ///< in the order given
};

/// A source has become stale or lost, or is back.
struct ConnectionChange {
  std::string source = {};
  Connection state = Connection::Connected;
  double age = 0.0;  ///< s
};

/// `now` is a moment of the clock that the caller watches by: the log's while a log is replayed, that of the
/// machine for live data. It must not decrease; forget() before it does.
class ConnectionMonitor {
 public:
  ConnectionMonitor(const ConnectionRules& rules, std::vector<AnchorId> anchors);

  void arrived(const Measurement& measurement, Duration now);
  /// A line or reading of this source that was not taken.
  void refused(const std::string& source, const std::string& why, Duration now);
  void judged(const Measurement& measurement, Verdict verdict, Duration now);
  void forget();

  Connections at(Duration now) const;
  /// What changed since the last call; passages are not watched.
  std::vector<ConnectionChange> changes(Duration now);

 private:
  struct Second {
    std::int64_t number = -1;
    std::uint32_t tested = 0;
    std::uint32_t gated = 0;
  };
  struct Watched {
    std::string kind = {};
    std::optional<Duration> heard = {};
    std::vector<double> intervals = {};  ///< s, of the last five
    std::uint64_t count = 0;
    std::uint64_t refused = 0;
    std::string why = {};
    bool last_refused = false;
    std::vector<Second> seconds = {};
    std::optional<Verdict> last_tested = {};
    Connection told = Connection::Waiting;
  };
  static void hear(Watched& watched, Duration now);
  static void judge(Watched& watched, Verdict verdict, Duration now);
  Connection stateOf(const Watched& watched, Duration now) const;
  Link linkOf(const Watched& watched, Duration now) const;

  ConnectionRules rules_;
  std::vector<AnchorId> order_;
  mutable std::mutex mutex_;
  std::map<std::string, Watched> sources_;
  std::map<AnchorId, Watched> anchors_;
};

}  // namespace pos::serve
