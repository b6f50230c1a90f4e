#include "campaign.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <mutex>

#include "pos/core/error.hpp"
#include "pos/io/scenario_yaml.hpp"
#include "pos/io/sha256.hpp"
#include "pos/report/campaign_files.hpp"
#include "replay.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostMoments = 200'000;

/// From the first to the last reference pose; nothing without truth.
std::optional<eval::TimeGrid> gridOf(const Inputs& inputs) {
  if (!inputs.truth || inputs.truth->poses.empty()) return std::nullopt;
  const io::RunConfig& config = inputs.config;
  const Duration step = durationFromSeconds(config.campaign.step.value_or(1.0 / config.record.max_rate));
  const Duration offset = durationFromSeconds(config.evaluation.truth_time_offset);
  const Duration span = inputs.truth->poses.back().stamp - inputs.truth->poses.front().stamp;
  const auto count = static_cast<std::size_t>(span / step) + 1;
  if (count > kMostMoments) {
    throw ConfigError(Complaint{
        .what = "the runs would be compared at too many moments",
        .key = "campaign.step_s",
        .got = std::to_string(count) + " moments of " + std::to_string(seconds(step)) + " s",
        .expected = "at most " + std::to_string(kMostMoments),
        .suggestion =
            "set campaign.step_s to " +
            std::to_string(1 + static_cast<long>(seconds(span) / static_cast<double>(kMostMoments))) +
            " or more"});
  }
  return eval::TimeGrid{.origin = inputs.truth->poses.front().stamp + offset, .step = step, .count = count};
}

/// Checksum of what the figures of a run depend on beside the inputs' content: not of paths and names.
std::string settingsOf(const Inputs& inputs) {
  io::RunConfig config = inputs.config;
  config.name = "-";
  config.campaign.baseline.reset();
  if (config.log) config.log->file = "-";
  if (config.scenario) config.scenario->file = "-";
  if (config.map) config.map = "-";
  if (config.truth && config.truth->file) config.truth->file = "-";
  std::string all = io::resolvedYaml(config);
  if (inputs.scenario) {  // with its vehicle, which may stand in a file of its own
    sim::Scenario scenario = *inputs.scenario;
    scenario.map.reset();
    all += io::resolvedYaml(scenario);
  }
  return io::sha256(all);
}

Manifest manifestOf(const InputOptions& options, const Inputs& inputs, std::uint64_t runs) {
  const io::RunConfig& config = inputs.config;
  Manifest m;
  m.head.name = config.name;
  m.head.input = inputFiles(inputs).front().file.filename().string();
  m.head.recorded = config.log.has_value();
  m.head.map = inputs.map->name;
  m.head.seed = config.seed;
  m.head.runs = runs;
  m.head.step = inputs.grid ? seconds(inputs.grid->step) : 0.0;
  m.head.baseline = config.campaign.baseline.value_or(config.estimators.front().name);
  m.version = version();
  m.git = gitHash();
  for (const InputFile& input : inputFiles(inputs))
    m.inputs.push_back({input.role, input.file.string(), io::sha256OfFile(input.file)});
  m.config = io::resolvedYaml(config);
  m.settings = settingsOf(inputs);
  m.command = repeatCommand(options, config.seed);
  return m;
}

/// In single quotes where a shell would read anything else into it.
std::string shellWord(const std::string& word) {
  const std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// An error of one run, with its number and the command that shows it again.
Complaint ofRun(Complaint complaint, std::uint64_t run, const std::string& repeat) {
  complaint.what += " (run " + std::to_string(run) + ")";
  complaint.suggestion += (complaint.suggestion.empty() ? "" : "; ") + ("see it alone: " + repeat);
  return complaint;
}

void addFaces(eval::CampaignRun& record, const std::vector<eval::EstimatorFace>& faces) {
  for (eval::CampaignEntry& entry : record.estimators) {
    for (const auto& [name, face] : faces) {
      if (name == entry.name) entry.metrics.merge(eval::faceMetrics(face));
    }
  }
}

/// The record of one run; empty when it was stopped.
std::string recordOf(const CampaignPlan& plan, std::uint64_t run, const Stop& stop) {
  const std::uint64_t seed = eval::seedOfRun(plan.inputs.config.seed, run);
  const std::string repeat = repeatCommand(plan.options, seed);
  try {
    const Inputs inputs = inputsOfRun(plan.file, plan.options, seed, plan.inputs);
    const Replayed result = replayed(inputs, nullptr, [&](std::uint64_t, Stamp) { return !stop(); });
    if (result.interrupted) return "";
    if (result.log_end.damaged)
      throw DataError(Complaint{.what = "the log is damaged", .got = result.log_end.message});
    eval::CampaignRun record = eval::campaignRun(summaryOf(inputs, result), run, repeat);
    addFaces(record, extrasOf(inputs, result).faces);
    return report::campaignRunJson(record, plan.manifest.fingerprint());
  } catch (const DataError& error) {
    throw DataError(ofRun(error.complaint(), run, repeat));
  } catch (const ConfigError& error) {
    throw ConfigError(ofRun(error.complaint(), run, repeat));
  } catch (const ContractError& error) {
    throw ContractError(error.what() + (" (run " + std::to_string(run) + ": " + repeat + ")"));
  }
}

}  // namespace

std::string repeatCommand(const InputOptions& options, std::uint64_t seed) {
  std::string command = "pos replay " + shellWord(options.config);
  const auto add = [&command](const char* option, const std::string& value) {
    if (!value.empty()) command += std::string(" ") + option + " " + shellWord(value);
  };
  add("--log", options.log);
  add("--map", options.map);
  add("--truth", options.truth);
  add("--truth-format", options.truth_format);
  for (const std::string& change : options.overrides) add("--set", change);
  return command + " --seed " + std::to_string(seed);
}

CampaignPlan loadCampaign(const InputOptions& options, std::uint64_t runs) {
  CampaignPlan plan{options, io::loadYaml(options.config), loadInputs(options), {}};
  plan.inputs.grid = gridOf(plan.inputs);
  plan.manifest = manifestOf(options, plan.inputs, runs);
  return plan;
}

std::size_t doRuns(const CampaignPlan& plan, const std::vector<std::uint64_t>& runs, int jobs,
                   RunRecords& records, const RunDone& done, const Stop& stop) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::mutex telling;
  std::size_t count = 0;
  const Stop enough = [&] { return failed || stop(); };
  const auto work = [&](int) {
    for (std::size_t i = next++; i < runs.size() && !enough(); i = next++) {
      try {
        const std::string record = recordOf(plan, runs[i], enough);
        if (record.empty()) return;
        records.put(runs[i], record);
      } catch (...) {
        failed = true;
        throw;
      }
      const std::scoped_lock lock(telling);
      done(runs[i], ++count);
    }
  };
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(jobs));
  tbb::task_arena arena(jobs);
  arena.execute([&] { tbb::parallel_for(0, jobs, work, tbb::simple_partitioner{}); });
  return count;
}

eval::CampaignSummary summaryOfRuns(const Manifest& manifest, const RunRecords& records) {
  eval::CampaignTotals totals(manifest.head);
  const std::string fingerprint = manifest.fingerprint();
  for (std::uint64_t run = 0; run < manifest.head.runs; ++run) {
    if (!records.has(run)) continue;
    totals.add(report::campaignRunFrom(records.text(run), records.place(run), fingerprint));
  }
  return totals.summary();
}

}  // namespace pos::app
