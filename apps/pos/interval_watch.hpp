#pragma once
/// Interval positioning beside one estimator: from its estimates to intervals, and back to it what the map
/// knows.

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "pos/eval/interval_figures.hpp"
#include "pos/interval/interval_tracker.hpp"
#include "pos/interval/passages.hpp"
#include "pos/interval/road_aid.hpp"
#include "pos/io/interval_csv.hpp"
#include "pos/io/interval_options.hpp"

namespace pos::app {

/// Roads, their graph and their division, shared by all estimators of a run.
struct IntervalGround {
  map::RoadGraph graph;
  eval::IntervalScene scene;
};
/// Throws ConfigError for a map without roadways.
std::shared_ptr<const IntervalGround> intervalGround(const std::shared_ptr<const map::TunnelMap>& map,
                                                     const io::IntervalsConfig& config);

class IntervalWatch {
 public:
  IntervalWatch(std::shared_ptr<const IntervalGround> ground, const io::IntervalsConfig& config,
                std::string estimator);

  void openFile(const io::RunFolder& folder);
  /// Takes what the estimator says after the last measurement of a stamp; what the tracker makes of it, where
  /// there is a covariance.
  std::optional<interval::IntervalBelief> take(const Estimate& estimate);
  /// From now on the record for the evaluation stays empty.
  void keepNothing() { keep_ = false; }
  void flush();
  /// A fix for the estimator, when it is time for one and it is to be aided.
  std::optional<Measurement> offered(const Estimate& estimate);
  /// The estimator takes no such fixes.
  void stopOffering() { aiding_ = false; }

  /// What is to be done with a measurement: anything but the passage of a chamber of the map goes on as told.
  io::PassageUse useOf(const Measurement& measurement) const;
  /// What the estimator may be given instead; nothing when the passage is not believed. `here` is what the
  /// estimator says at that moment, if it does.
  std::optional<Measurement> checked(const Measurement& measurement, const std::optional<Estimate>& here);

  /// Lines for events.csv since the last call.
  std::vector<io::RunEvent> takeEvents() { return std::exchange(lines_, {}); }
  eval::IntervalRecord finish();

 private:
  void note(const interval::IntervalEvent& event);

  std::shared_ptr<const IntervalGround> ground_;
  std::string estimator_;
  interval::IntervalTracker tracker_;
  interval::RoadAid aid_;
  interval::PassageCheck passages_;
  bool aiding_ = false;
  bool keep_ = true;
  io::PassageUse use_ = io::PassageUse::AsTold;
  std::optional<io::IntervalsCsvWriter> file_;
  eval::IntervalRecord record_;
  std::vector<io::RunEvent> lines_;
};

}  // namespace pos::app
