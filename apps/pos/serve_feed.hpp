#pragma once
/// Where live measurements come from: JSON lines on standard input or on a TCP port.

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "pos/core/measurement.hpp"

namespace pos::app {

/// What the feeding threads hand over. Called by several threads at a time.
struct FeedEars {
  std::function<void(Measurement)> measurement;
  /// "line 17 of sender 1: ...", and the sensor that the line names, where it does.
  std::function<void(const std::string& what, const std::string& sensor)> bad_line;
  std::function<void()> ended;  ///< standard input has ended
};

/// Reads until it is destroyed. One source that is silent or talks nonsense does not hold up another.
class Feed {
 public:
  explicit Feed(FeedEars ears) : ears_(std::move(ears)) {}
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;
  Feed(Feed&&) = delete;
  Feed& operator=(Feed&&) = delete;
  ~Feed();

  void readStandardInput();
  /// Listens for any number of senders; 0 takes a free port. Returns the port. Throws UsageError when it
  /// cannot be had.
  int listen(const std::string& address, int port);

 private:
  void readFrom(int file, const std::string& source);
  void accept(int socket);

  FeedEars ears_;
  std::atomic<bool> stopping_{false};
  std::atomic<int> senders_{0};
  std::vector<std::thread> threads_;
};

}  // namespace pos::app
