#pragma once
/// Server-Sent Events for any number of browsers: every message is made once.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "serve_session.hpp"

namespace pos::app {

class Hub {
 public:
  void publish(std::string_view event, std::string_view data);
  void close();
  bool closed() const { return closed_; }

  /// Messages from number `from` on, waiting for one for at most a second. Of several states the newest.
  struct Batch {
    std::string text = {};
    std::uint64_t next = 0;
  };
  Batch after(std::uint64_t from);
  /// For a new listener: the last state, and the number of the next message.
  Batch beginning();

 private:
  struct Message {
    std::string text;
    bool state = false;
  };
  static constexpr std::size_t kKept = 256;

  std::mutex mutex_;
  std::condition_variable grown_;
  std::deque<Message> messages_;
  std::uint64_t first_ = 0;  // number of messages_.front()
  std::string last_state_;
  std::atomic<bool> closed_{false};
};

/// Twenty times a second the state of the session, where it changed; its events; once a second a heartbeat.
class Ticker {
 public:
  Ticker(Session& session, Hub& hub, const Clock& clock);
  ~Ticker();
  Ticker(const Ticker&) = delete;
  Ticker& operator=(const Ticker&) = delete;
  Ticker(Ticker&&) = delete;
  Ticker& operator=(Ticker&&) = delete;

  /// The state of this moment, with its number.
  std::string state();

 private:
  void run();
  void tellEvents();

  Session& session_;
  Hub& hub_;
  Clock clock_;
  std::mutex mutex_;  // of the two below
  std::string body_;
  std::uint64_t seq_ = 0;
  std::uint64_t published_ = 0;
  std::uint64_t events_ = 0;
  std::uint64_t resets_ = 0;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace pos::app
