#pragma once
/// Measurements through every estimator of a configuration, whoever hands them in: a replay, a show in a
/// browser, a live feed.

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
  Pass(const Inputs& inputs, const io::RunFolder* folder, Keep keep = Keep::All);

  void take(Measurement measurement);
  /// The same with many, the estimators side by side in threads. The results are the same, bit by bit.
  void takeAll(std::vector<Measurement>& measurements);
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
  /// What every recorder does next.
  struct Step {
    enum class Kind { Take, Withhold, EndEpoch } kind;
    Measurement measurement;  ///< of EndEpoch only the stamp
  };
  /// An event and the step that it came of.
  struct Told {
    std::size_t step;
    io::RunEvent event;
  };

  void push(Measurement measurement);
  void drain();
  void beginEpoch(Stamp stamp);
  void endEpoch();
  void run(bool side_by_side);
  std::vector<Told> goThrough(Recorder& recorder) const;
  void note(const io::RunEvent& event);

  const Inputs& inputs_;
  estimation::Sequencer sequencer_;
  io::RangeFaults faults_;
  std::vector<Recorder> recorders_;
  /// Recorders that may run at the same time, each group one after the other.
  std::vector<std::vector<std::size_t>> groups_;
  std::vector<Step> steps_;
  std::optional<io::EventsCsvWriter> events_;
  std::function<void(const io::RunEvent&)> on_event_;
  std::optional<Stamp> epoch_;
  bool started_ = false;
  Replayed result_;
};

}  // namespace pos::app
