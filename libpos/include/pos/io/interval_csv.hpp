#pragma once
/// The answers of an interval tracker as a table.

#include <filesystem>
#include <string>
#include <vector>

#include "pos/interval/interval_tracker.hpp"
#include "pos/io/run_folder.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::io {

/// Columns in docs/formats/trajectories.md. One row an answer; intervals by id with their probabilities.
class IntervalsCsvWriter {
 public:
  IntervalsCsvWriter(const std::filesystem::path& path, const map::TunnelMap& map,
                     const std::vector<map::LockInterval>& intervals);
  void write(const interval::IntervalBelief& belief);
  void flush() { lines_.flush(); }
  void close() { lines_.close(); }

 private:
  LineWriter lines_;
  std::vector<std::string> roadways_;
  std::vector<std::string> ids_;
};

/// The event as a line of events.csv: kind "interval_entry", "interval_exit", "branch_open",
/// "branch_decided", "road_lost" or "road_found".
RunEvent runEvent(const interval::IntervalEvent& event, const std::string& estimator,
                  const std::vector<map::LockInterval>& intervals);

}  // namespace pos::io
