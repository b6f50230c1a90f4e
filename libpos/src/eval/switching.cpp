#include "pos/eval/switching.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace pos::eval {
namespace {

using States = std::vector<ModeState>;
using Delay = std::optional<double> (ModeSwitch::*)() const;

std::size_t leading(const States& modes) {
  const auto best = std::max_element(
      modes.begin(), modes.end(), [](const auto& a, const auto& b) { return a.probability < b.probability; });
  return static_cast<std::size_t>(best - modes.begin());
}

/// The usable mode with the best readings; the count of modes where none is usable.
std::size_t mostAccurate(const States& modes) {
  std::size_t best = modes.size();
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (!modes[i].usable) continue;
    if (best == modes.size() || modes[i].sigma < modes[best].sigma) best = i;
  }
  return best;
}

bool sameSet(const States& a, const States& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
           return x.usable == y.usable;
         });
}

bool none(const States& modes) {
  return std::none_of(modes.begin(), modes.end(), [](const ModeState& m) { return m.usable; });
}

std::string inUse(const States& modes) {
  std::string names;
  for (const ModeState& mode : modes) {
    if (mode.usable) names += (names.empty() ? "" : " + ") + std::string(mode.name);
  }
  return names;
}

std::optional<double> between(Stamp from, const std::optional<Stamp>& to) {
  return to ? std::optional(seconds(*to - from)) : std::nullopt;
}

std::vector<double> delays(const std::vector<ModeSwitch>& switches, Delay delay) {
  std::vector<double> all;
  for (const ModeSwitch& each : switches)
    all.push_back(std::invoke(delay, each).value_or(std::numeric_limits<double>::infinity()));
  return all;
}

std::optional<double> meanOf(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::optional<double> maxOf(const std::vector<double>& values) {
  return values.empty() ? std::nullopt : std::optional(*std::max_element(values.begin(), values.end()));
}

}  // namespace

std::optional<double> ModeSwitch::delay() const {
  return between(started, settled);
}
std::optional<double> ModeSwitch::delayToBetter() const {
  return between(started, settled_on_better);
}
std::optional<double> ModeSwitch::wait() const {
  return boundary ? std::optional(seconds(started - *boundary)) : std::nullopt;
}

std::size_t SwitchingFigures::failed() const {
  return static_cast<std::size_t>(
      std::count_if(switches.begin(), switches.end(), [](const ModeSwitch& s) { return !s.settled; }));
}
std::optional<double> SwitchingFigures::meanDelay() const {
  return meanOf(delays(switches, &ModeSwitch::delay));
}
std::optional<double> SwitchingFigures::maxDelay() const {
  return maxOf(delays(switches, &ModeSwitch::delay));
}
std::optional<double> SwitchingFigures::meanDelayToBetter() const {
  return meanOf(delays(switches, &ModeSwitch::delayToBetter));
}
std::optional<double> SwitchingFigures::maxDelayToBetter() const {
  return maxOf(delays(switches, &ModeSwitch::delayToBetter));
}

void SwitchingWatch::take(Stamp stamp, const States& modes) {
  if (modes.empty()) return;
  // Finding the first model and losing the last are a start and an outage, not a switch.
  if (before_.size() == modes.size() && !none(before_) && !none(modes) && !sameSet(before_, modes))
    begin(modes);
  if (open_) follow(stamp, modes);
  before_ = modes;
}

void SwitchingWatch::begin(const States& modes) {
  ModeSwitch next;
  std::optional<Stamp> started;
  joined_.assign(modes.size(), false);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (modes[i].usable == before_[i].usable) continue;
    joined_[i] = modes[i].usable;
    next.change +=
        (next.change.empty() ? "" : " ") + std::string(joined_[i] ? "+" : "-") + std::string(modes[i].name);
    if (!started || modes[i].since < *started) started = modes[i].since;
  }
  next.started = *started;
  next.from = inUse(before_);
  next.to = inUse(modes);
  switches_.push_back(std::move(next));
  strict_ = better_ = {};
  open_ = true;
}

bool SwitchingWatch::settledAt(const States& modes, bool better_is_enough) const {
  const std::size_t lead = leading(modes);
  const std::size_t best = mostAccurate(modes);
  if (lead != leading(before_)) return false;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const ModeState& mode = modes[i];
    if (std::abs(mode.probability - before_[i].probability) > rules_.change) return false;
    if (!mode.usable) {
      if (mode.probability > rules_.off) return false;
      continue;
    }
    if (!mode.last_applied || *mode.last_applied < switches_.back().started) return false;
    if (!joined_[i]) continue;
    if (i == best && lead != i) return false;  // the better one has to lead
    const bool counts = mode.probability >= rules_.on || (better_is_enough && i != best && lead == best);
    if (!counts) return false;
  }
  return true;
}

void SwitchingWatch::follow(Stamp stamp, const States& modes) {
  ModeSwitch& now = switches_.back();
  if (stamp - now.started > rules_.give_up) {
    open_ = false;
    return;
  }
  const auto look = [&](Run& run, std::optional<Stamp>& settled, bool better_is_enough) {
    if (settled) return;
    if (!settledAt(modes, better_is_enough)) {
      run = {};
      return;
    }
    if (run.length++ == 0) run.first = stamp;
    if (run.length >= rules_.epochs) settled = run.first;
  };
  look(strict_, now.settled, false);
  look(better_, now.settled_on_better, true);
  open_ = !now.settled || !now.settled_on_better;
}

SwitchingFigures SwitchingWatch::finish(const std::vector<Stamp>& boundaries) const {
  SwitchingFigures figures{switches_};
  for (ModeSwitch& each : figures.switches) {
    const auto after = std::upper_bound(boundaries.begin(), boundaries.end(), each.started);
    if (after == boundaries.begin()) continue;
    if (each.started - *(after - 1) <= rules_.give_up) each.boundary = *(after - 1);
  }
  return figures;
}

}  // namespace pos::eval
