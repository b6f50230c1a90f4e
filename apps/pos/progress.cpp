#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

namespace pos::app {
namespace {

volatile std::sig_atomic_t interrupt_came = 0;

/// The first asks for an end in good order, the second ends at once.
void onInterrupt(int signal) {
  interrupt_came = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

ProgressLine::ProgressLine(const Voice& voice, std::string verb, std::optional<Stamp> end)
    : verb_(std::move(verb)), shown_(!voice.quiet && isatty(STDERR_FILENO) != 0), end_(end) {}

ProgressLine::~ProgressLine() {
  if (drawn_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::draw(std::uint64_t measurements, Stamp stamp) {
  if (!shown_) return;
  if (!start_) start_ = stamp;
  drawn_ = true;
  const double done = seconds(stamp - *start_);
  const double whole = end_ ? seconds(*end_ - *start_) : 0.0;
  const double share = whole > 0.0 ? std::clamp(done / whole, 0.0, 1.0) : 0.0;
  const auto filled = static_cast<std::size_t>(30.0 * share);
  const std::string bar =
      whole > 0.0 ? "[" + std::string(filled, '=') + std::string(30 - filled, ' ') + "] " : "";
  std::fprintf(stderr, "\r\033[K%s %s%.0f s of log, %llu measurements", verb_.c_str(), bar.c_str(), done,
               static_cast<unsigned long long>(measurements));
}

void watchInterrupts() {
  std::signal(SIGINT, onInterrupt);
  std::signal(SIGTERM, onInterrupt);
}

bool interrupted() {
  return interrupt_came != 0;
}

}  // namespace pos::app
