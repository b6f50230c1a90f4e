#pragma once
/// A small HTTP client that can also send what no client should.

#include <map>
#include <string>

namespace pos::replay {

struct HttpAnswer {
  int status = 0;                                   ///< 0: no answer
  std::map<std::string, std::string> headers = {};  ///< names in lower case
  std::string body = {};
};

/// Sends these bytes to the port of this machine and reads until the other side closes.
std::string exchanged(int port, const std::string& bytes);

HttpAnswer get(int port, const std::string& target, const std::string& headers = "");
/// `headers` end in \r\n each.
HttpAnswer send(int port, const std::string& method, const std::string& target, const std::string& body,
                const std::string& headers = "Content-Type: application/json\r\n");

/// An open stream of Server-Sent Events.
class EventStream {
 public:
  explicit EventStream(int port);
  EventStream(const EventStream&) = delete;
  EventStream& operator=(const EventStream&) = delete;
  EventStream(EventStream&&) noexcept;
  EventStream& operator=(EventStream&&) = delete;
  ~EventStream();

  /// Data of the next event of this name; empty when none comes within `timeout_ms` or the stream ends.
  std::string next(const std::string& name, int timeout_ms = 20'000);
  struct Arrived {
    int heartbeats = 0;
    int states = 0;
  };
  /// Takes the whole events that have come so far and counts them, without waiting.
  Arrived arrived();

 private:
  bool receive(int timeout_ms);

  int socket_ = -1;
  std::string buffer_;
};

/// Sends JSON lines to a live feed; closes when destroyed.
class Sender {
 public:
  explicit Sender(int port);
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;
  Sender(Sender&&) = delete;
  Sender& operator=(Sender&&) = delete;
  ~Sender();
  /// Throws when the other side has gone.
  void send(const std::string& text) const;

 private:
  int socket_ = -1;
};

}  // namespace pos::replay
