#pragma once
/// Many runs of one configuration, each with a seed of its own, on several threads.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "campaign_folder.hpp"
#include "inputs.hpp"
#include "pos/io/yaml_document.hpp"

namespace pos::app {

/// Everything the runs share, loaded once and checked.
struct CampaignPlan {
  InputOptions options;   ///< the command line; seed: of the campaign
  io::YamlDocument file;  ///< the configuration as it was when the campaign began
  Inputs inputs;          ///< map, truth and grid of all runs; its own configuration has the campaign's seed
  Manifest manifest;
};

CampaignPlan loadCampaign(const InputOptions& options, std::uint64_t runs);

/// The command line that repeats a run alone.
std::string repeatCommand(const InputOptions& options, std::uint64_t seed);

/// Called after every run with its number and how many are done in this call, one call at a time.
using RunDone = std::function<void(std::uint64_t run, std::size_t done)>;
/// True: stop, leaving the runs under way without a record.
using Stop = std::function<bool()>;

/// Does the runs listed, in that order, on `jobs` threads, and puts a record of each into `records` as soon
/// as it is done. Returns how many were done. An error of a run stops the others and names the run.
std::size_t doRuns(const CampaignPlan& plan, const std::vector<std::uint64_t>& runs, int jobs,
                   RunRecords& records, const RunDone& done, const Stop& stop);

/// All runs below manifest.head.runs that have a record, taken together. Does not depend on who did them.
eval::CampaignSummary summaryOfRuns(const Manifest& manifest, const RunRecords& records);

}  // namespace pos::app
