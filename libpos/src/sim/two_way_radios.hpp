#pragma once
/// The radios of one run in two-way ranging: each its clock and antenna. Private to sim.

#include <vector>

#include "pos/sim/uwb_stream.hpp"

namespace pos::sim {

class TwoWayRadios {
 public:
  TwoWayRadios(const UwbConfig& config, std::size_t anchors, const RunSetup& run);

  /// Range from the counts of one exchange begun at `begin` (s) over `flights` (m); calibrated antenna delays
  /// are taken off.
  double range(std::size_t tag, std::size_t anchor, double begin, const std::array<double, 3>& flights);

 private:
  TwoWayConfig config_;
  double antenna_delay_;
  std::vector<RadioClock> tags_ = {};
  std::vector<RadioClock> anchors_ = {};
  std::vector<RandomStream> receive_ = {};
};

}  // namespace pos::sim
