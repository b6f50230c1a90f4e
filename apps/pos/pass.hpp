#pragma once
/// Measurements through every estimator of a configuration, one at a time, whoever hands them in: a replay, a
/// show in a browser, a live feed.

#include <functional>
#include <optional>
#include <vector>

#include "pos/estimation/sequencer.hpp"
#include "pos/io/range_faults.hpp"
#include "recorder.hpp"
#include "replay.hpp"

namespace pos::app {

class Pass {
 public:
  /// Keeps a reference to `inputs`. Files go to `folder` where there is one.
  Pass(const Inputs& inputs, const io::RunFolder* folder);

  void take(Measurement measurement);
  /// No more measurements will come: those that waited for their turn go through.
  void finish();
  /// The same, then the files are closed and the records handed out.
  Replayed finished(const io::LogEnd& end);
  /// What is recorded so far goes to the disk.
  void flush();

  /// Stamp of the latest measurement that the estimators have had.
  Stamp reached() const { return result_.last; }
  std::vector<Recorder>& recorders() { return recorders_; }
  const std::shared_ptr<const IntervalGround>& intervals() const { return result_.intervals; }
  /// Also told every event of events.csv.
  void onEvent(std::function<void(const io::RunEvent&)> ear) { on_event_ = std::move(ear); }

 private:
  void push(Measurement measurement);
  void drain();
  void beginEpoch(Stamp stamp);
  void takeBy(Recorder& recorder, const Measurement& measurement);
  void note(const io::RunEvent& event);
  void endEpoch();

  const Inputs& inputs_;
  estimation::Sequencer sequencer_;
  io::RangeFaults faults_;
  std::vector<Recorder> recorders_;
  std::optional<io::EventsCsvWriter> events_;
  std::function<void(const io::RunEvent&)> on_event_;
  std::optional<Stamp> epoch_;
  bool started_ = false;
  Replayed result_;
};

}  // namespace pos::app
