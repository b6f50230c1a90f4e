#pragma once
/// The roadway's line and heading given back to an estimator, as a run with `intervals: {aiding: true}` does.

#include <memory>
#include <optional>

#include "pos/estimation/estimator.hpp"
#include "pos/interval/road_aid.hpp"
#include "pos/io/interval_options.hpp"
#include "pos/map/network.hpp"
#include "pos/map/routes.hpp"

namespace pos::testing {

/// Stays where it is made: the tracker keeps the graph's address.
class RoadHelp {
 public:
  RoadHelp(const std::shared_ptr<const map::TunnelMap>& map, const io::IntervalsConfig& config)
      : network_(map),
        graph_(network_),
        tracker_(network_, graph_, config.match()),
        aid_(network_, config.aid()) {}
  RoadHelp(const RoadHelp&) = delete;
  RoadHelp& operator=(const RoadHelp&) = delete;

  void give(estimation::Estimator& estimator, Stamp stamp) {
    const auto estimate = estimator.estimateAt(stamp);
    if (!estimate || !estimate->planarCovariance().allFinite()) return;
    tracker_.take(*estimate);
    if (const auto fix = aid_.offered(*estimate, tracker_)) (void)estimator.ingest(*fix);
  }

 private:
  map::Network network_;
  map::RoadGraph graph_;
  interval::RoadTracker tracker_;
  interval::RoadAid aid_;
};

}  // namespace pos::testing
