#pragma once
/// One run of a campaign, small enough to keep: what is written down before the next run starts.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pos/eval/run_summary.hpp"

namespace pos::eval {

/// One estimator in one run.
struct CampaignEntry {
  std::string name;
  std::string type;
  /// Names as in metrics(), without compute times: those depend on the machine.
  std::map<std::string, std::optional<double>> metrics;
  std::map<std::string, std::uint64_t> events;  ///< how often each happened
  std::vector<GridCell> cells;                  ///< on the campaign's grid; empty without truth
};

struct CampaignRun {
  std::uint64_t index = 0;  ///< from 0
  std::uint64_t seed = 0;
  std::string repeat;  ///< the command that repeats this run alone
  std::vector<CampaignEntry> estimators;
};

/// Seed of run `index`: the first 53 bits of Philox4x32-10 for counter (index, 2) and key `campaign_seed`, so
/// that runs of neighbouring campaign seeds have nothing in common, and every JSON reader keeps all digits.
std::uint64_t seedOfRun(std::uint64_t campaign_seed, std::uint64_t index);

/// A part of the runs: those whose index leaves the remainder number - 1 when divided by count.
struct Shard {
  std::uint64_t number = 1;  ///< 1 .. count
  std::uint64_t count = 1;

  bool holds(std::uint64_t index) const { return index % count == number - 1; }
};

CampaignRun campaignRun(const RunSummary& run, std::uint64_t index, const std::string& repeat);

}  // namespace pos::eval
