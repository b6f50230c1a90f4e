#pragma once
/// The command `pos` while it runs: servers.

#include <string>
#include <vector>

#include "replay/run_pos.hpp"

namespace pos::replay {

/// The command running beside the test, in the folder of a Bench; killed at the latest at the end.
class Running {
 public:
  /// Its standard input is a pipe from the test.
  Running(const Bench& bench, const std::vector<std::string>& arguments);
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  Running(Running&&) = delete;
  Running& operator=(Running&&) = delete;
  ~Running();

  /// The number after `words` on its output, which is waited for: a port. Throws when it does not come within
  /// a minute, or the command ends.
  int numberAfter(const std::string& words) const;
  std::string out() const;
  std::string err() const;
  void feed(const std::string& text) const;
  void closeInput();
  void signal(int number) const;
  /// Its exit code; -1 when a signal ended it.
  int wait();
  /// Resident memory, bytes.
  std::size_t memory() const;

 private:
  std::filesystem::path out_;
  std::filesystem::path err_;
  int input_ = -1;
  int child_ = 0;
};

}  // namespace pos::replay
