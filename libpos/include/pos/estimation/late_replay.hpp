#pragma once
/// Late measurements put in their place: the estimator goes back to how it was before, and takes everything
/// since then again. Without a lag it costs nothing.

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "pos/estimation/estimator.hpp"

namespace pos::estimation {

/// `Core` is what an Estimator is, without being one: copyable, with reset, ingest, estimateAt, diagnostics.
template <class Core>
class LateReplay final : public Estimator {
 public:
  /// Measurements up to `lag` seconds behind the newest are replayed; older ones are TooOld.
  LateReplay(Core core, double lag) : core_(std::move(core)), lag_(durationFromSeconds(lag)) {}

  void reset(Stamp stamp, const Belief<Pose2>& prior) override {
    core_.reset(stamp, prior);
    forget(stamp);
  }

  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override {
    if (lag_.count() <= 0) return core_.ingest(measurement);
    if (newest_ && measurement.stamp < *newest_) return replayed(measurement);
    return remembered(measurement);
  }

  std::optional<Estimate> estimateAt(Stamp stamp) const override { return core_.estimateAt(stamp); }

  Diagnostics diagnostics() const override {
    Diagnostics values = core_.diagnostics();
    if (lag_.count() > 0) values.push_back({"replays", static_cast<double>(replays_)});
    return values;
  }

 private:
  static constexpr int kStates = 16;  ///< kept over the lag

  /// How it was once everything stamped up to `stamp` had been taken.
  struct State {
    Stamp stamp;
    Core core;
  };

  void forget(Stamp stamp) {
    states_.clear();
    log_.clear();
    newest_ = stamp;
  }

  IngestReport remembered(const Measurement& measurement) {
    keepState(measurement.stamp);
    const IngestReport report = core_.ingest(measurement);
    if (report.verdict == Verdict::Unsupported || report.verdict == Verdict::Degenerate) return report;
    log_.push_back(measurement);
    newest_ = measurement.stamp;
    return report;
  }

  /// Before the first measurement of a later stamp.
  void keepState(Stamp next) {
    if (!newest_ || next <= *newest_) return;
    if (!states_.empty() && *newest_ - states_.back().stamp < lag_ / kStates) return;
    states_.push_back({*newest_, core_});
    // One state at or before the oldest stamp that may still come.
    while (states_.size() > 1 && states_[1].stamp <= *newest_ - lag_) states_.pop_front();
    while (!log_.empty() && log_.front().stamp <= states_.front().stamp) log_.pop_front();
  }

  IngestReport replayed(const Measurement& measurement) {
    const auto tooOld =
        IngestReport{.verdict = Verdict::TooOld, .reason = "older than the state and its lag"};
    if (measurement.stamp < *newest_ - lag_) return tooOld;
    std::size_t from = states_.size();
    while (from > 0 && states_[from - 1].stamp > measurement.stamp) --from;
    if (from == 0) return tooOld;
    Core before = std::exchange(core_, states_[from - 1].core);
    const Stamp start = states_[from - 1].stamp;
    const auto later = [](Stamp stamp, const Measurement& m) { return stamp < m.stamp; };
    std::deque<Measurement> pending(std::upper_bound(log_.begin(), log_.end(), start, later), log_.end());
    const auto place = std::upper_bound(pending.begin(), pending.end(), measurement.stamp, later);
    const auto index = static_cast<std::size_t>(place - pending.begin());
    for (std::size_t i = 0; i < index; ++i) (void)core_.ingest(pending[i]);
    const IngestReport report = core_.ingest(measurement);
    if (report.verdict == Verdict::Unsupported || report.verdict == Verdict::Degenerate) {
      core_ = std::move(before);
      return report;
    }
    states_.erase(states_.begin() + static_cast<std::ptrdiff_t>(from), states_.end());
    const Stamp end = *newest_;
    log_.erase(log_.end() - static_cast<std::ptrdiff_t>(pending.size() - index), log_.end());
    log_.push_back(measurement);
    newest_ = measurement.stamp;
    for (std::size_t i = index; i < pending.size(); ++i) (void)remembered(pending[i]);
    newest_ = std::max(*newest_, end);
    ++replays_;
    return report;
  }

  Core core_;
  Duration lag_;
  std::deque<State> states_;
  std::deque<Measurement> log_;  // since the oldest state, by stamp
  std::optional<Stamp> newest_;
  int replays_ = 0;
};

}  // namespace pos::estimation
