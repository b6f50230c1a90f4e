/// `pos campaign`: many seeds of one configuration, taken together.

#include <tbb/info.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>

#include "campaign.hpp"
#include "campaign_results.hpp"
#include "pos/core/error.hpp"
#include "pos/eval/campaign_requirement.hpp"
#include "pos/report/text.hpp"
#include "progress.hpp"

namespace pos::app {
namespace {

struct Options {
  InputOptions inputs;
  OutputOptions outputs;
  std::uint64_t runs = 0;
  int jobs = 0;
  std::string shard;
  bool dry_run = false;
};

/// How far the campaign is and how long it will take, on a terminal only.
class RunLine {
 public:
  RunLine(const Voice& voice, std::size_t runs)
      : shown_(!voice.quiet && isatty(STDERR_FILENO) != 0), runs_(runs) {
    draw(0);
  }
  ~RunLine() { clear(); }
  RunLine(const RunLine&) = delete;
  RunLine& operator=(const RunLine&) = delete;
  RunLine(RunLine&&) = delete;
  RunLine& operator=(RunLine&&) = delete;

  void clear() const {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }
  void draw(std::size_t done) const {
    if (!shown_ || runs_ == 0) return;
    const std::size_t filled = 30 * done / runs_;
    const std::string bar = "[" + std::string(filled, '=') + std::string(30 - filled, ' ') + "] ";
    std::fprintf(stderr, "\r\033[Kcampaign %s%zu of %zu runs%s", bar.c_str(), done, runs_,
                 timeLeft(done).c_str());
  }

 private:
  std::string timeLeft(std::size_t done) const {
    if (done == 0) return "";
    const auto spent = std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now() - begin_);
    const double per_run = seconds(spent) / static_cast<double>(done);
    return ", " + report::durationText(durationFromSeconds(per_run * static_cast<double>(runs_ - done))) +
           " left";
  }

  bool shown_;
  std::size_t runs_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

[[noreturn]] void refuseUsage(const std::string& what, const std::string& key, const std::string& got,
                              const std::string& expected) {
  throw UsageError(Complaint{.what = what, .key = key, .got = got, .expected = expected});
}

std::uint64_t wholeNumber(const std::string& text) {
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != std::string::npos) return 0;
  return std::stoull(text);
}

eval::Shard parsedShard(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t slash = text.find('/');
  const std::string expected = "i/n with i from 1 to n, as in 2/4";
  if (slash == std::string::npos) refuseUsage("this is no part of a campaign", "--shard", text, expected);
  const eval::Shard shard{wholeNumber(text.substr(0, slash)), wholeNumber(text.substr(slash + 1))};
  if (shard.number < 1 || shard.number > shard.count)
    refuseUsage("there is no such part of a campaign", "--shard", text, expected);
  return shard;
}

void requireSense(const Options& options) {
  if (options.inputs.config.empty())
    refuseUsage("no configuration", "CONFIG", "", "a configuration file, or merge with the folders of parts");
  if (options.runs < 1)
    refuseUsage("a campaign needs runs", "--runs", std::to_string(options.runs), "1 or more");
  if (options.jobs < 0 || options.jobs > 4096) {
    refuseUsage("this many threads cannot be", "--jobs", std::to_string(options.jobs),
                "1 to 4096; 0: one a core");
  }
  if (options.shard.empty()) return;
  if (options.outputs.folder.empty())
    refuseUsage("a part of a campaign needs a folder for its runs", "--out", "", "--out FOLDER");
  if (options.outputs.json || !options.outputs.requirements.empty()) {
    refuseUsage("a part of a campaign is not judged alone", "--shard", options.shard,
                "--json and --require with `pos campaign merge`");
  }
}

std::vector<std::uint64_t> missingRuns(std::uint64_t runs, const eval::Shard& shard,
                                       const RunRecords& records) {
  std::vector<std::uint64_t> missing;
  for (std::uint64_t run = 0; run < runs; ++run) {
    if (shard.holds(run) && !records.has(run)) missing.push_back(run);
  }
  return missing;
}

ExitCode stopped(std::size_t done, std::uint64_t runs, const Voice& voice) {
  voice.warn("interrupted: " + std::to_string(done) + " of " + countText(runs) +
             " are done; the same command with --out does the rest");
  return ExitCode::Interrupted;
}

ExitCode runCampaign(const Options& options, const Voice& voice) {
  requireSense(options);
  const eval::Shard shard = parsedShard(options.shard);
  const CampaignPlan plan = loadCampaign(options.inputs, options.runs);
  for (const std::string& text : options.outputs.requirements) {
    std::vector<std::string> names;
    for (const io::EstimatorEntry& entry : plan.inputs.config.estimators) names.push_back(entry.name);
    eval::refuseUnknownOverRuns(text, names);
  }
  if (options.dry_run) {
    print(io::resolvedYaml(plan.inputs.config));
    voice.say("nothing was run: the configuration, the map and the truth are in order");
    return ExitCode::Ok;
  }
  const std::string& folder = options.outputs.folder;
  if (!folder.empty()) {
    openCampaignFolder(folder, plan.manifest,
                       options.outputs.force ? EarlierRuns::Drop : EarlierRuns::Continue);
  }
  std::unique_ptr<RunRecords> records =
      folder.empty() ? std::make_unique<RunRecords>() : std::make_unique<RunRecords>(folder);
  const std::vector<std::uint64_t> runs = missingRuns(options.runs, shard, *records);
  const int jobs = options.jobs > 0 ? options.jobs : tbb::info::default_concurrency();
  watchInterrupts();
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t done = [&] {
    const RunLine line(voice, runs.size());
    return doRuns(
        plan, runs, jobs, *records,
        [&](std::uint64_t run, std::size_t count) {
          line.clear();
          voice.detail("run " + std::to_string(run) + " is done");
          line.draw(count);
        },
        interrupted);
  }();
  const auto spent = std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now() - begin);
  voice.say((options.shard.empty() ? "" : "shard " + options.shard + ": ") + countText(done) + " in " +
            report::durationText(spent) + " with " + std::to_string(jobs) + (jobs == 1 ? " job" : " jobs"));
  if (!options.shard.empty()) {
    if (done < runs.size()) return stopped(done, runs.size(), voice);
    voice.say("when all shards are done: pos campaign merge " + folder + " --out RESULT");
    return ExitCode::Ok;
  }
  const eval::CampaignSummary campaign = summaryOfRuns(plan.manifest, *records);
  tell(plan.manifest, campaign, options.outputs, voice);
  if (done < runs.size()) return stopped(campaign.rows.size(), options.runs, voice);
  judge(campaign, options.outputs, voice);
  return ExitCode::Ok;
}

}  // namespace

void addCampaign(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand(
      "campaign", "Run many seeds of a configuration in parallel and take them together");
  auto options = std::make_shared<Options>();
  addInputs(*verb, options->inputs);
  verb->get_option("config")->required(false);
  verb->add_option("--runs", options->runs, "Number of runs")->check(kWholeNumber);
  verb->add_option("--jobs", options->jobs, "Runs at the same time (default: one a core)")
      ->check(kWholeNumber);
  verb->add_option("--shard", options->shard, "i/n: only this part of the runs, for another machine or job");
  addOutputs(*verb, options->outputs);
  verb->add_flag("--dry-run", options->dry_run,
                 "Check everything, print the resolved configuration, run nothing");
  addVoice(*verb, *verbs.voice);
  addCampaignMerge(*verb, verbs);
  verb->callback([options, verbs, verb] {
    if (verb->get_subcommands().empty()) *verbs.code = runCampaign(*options, *verbs.voice);
  });
}

}  // namespace pos::app
