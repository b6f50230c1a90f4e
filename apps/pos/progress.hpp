#pragma once
/// How far a long verb is, on one line of a terminal.

#include <cstdint>
#include <optional>
#include <string>

#include "common.hpp"
#include "pos/core/stamp.hpp"

namespace pos::app {

/// Drawn on standard error, on a terminal only; gone when the work is done. The bar needs the moment at which
/// the work ends.
class ProgressLine {
 public:
  ProgressLine(const Voice& voice, std::string verb, std::optional<Stamp> end);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ProgressLine(ProgressLine&&) = delete;
  ProgressLine& operator=(ProgressLine&&) = delete;

  /// `stamp` reached after so many measurements; the first call fixes the beginning.
  void draw(std::uint64_t measurements, Stamp stamp);

 private:
  std::string verb_;
  bool shown_;
  bool drawn_ = false;
  std::optional<Stamp> start_;
  std::optional<Stamp> end_;
};

/// From now on an interrupt (Ctrl-C) or a request to end ends the work at hand in good order instead of the
/// program; a second one ends the program.
void watchInterrupts();
bool interrupted();

}  // namespace pos::app
