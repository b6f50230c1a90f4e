/// `pos replay`: a log through several estimators at once, judged against the truth.

#include <tbb/global_control.h>

#include <memory>
#include <optional>

#include "outputs.hpp"
#include "pos/core/error.hpp"
#include "pos/report/comparison.hpp"
#include "progress.hpp"
#include "replay.hpp"
#include "viewer_page.hpp"

namespace pos::app {
namespace {

struct Options {
  InputOptions inputs;
  OutputOptions outputs;
  std::string interface;
  int jobs = 0;
  bool dry_run = false;
};

/// The threads that may work at the same time, while the result lives; the one that reads ahead not counted.
std::optional<tbb::global_control> limitTo(int jobs) {
  if (jobs == 0) return std::nullopt;
  return std::optional<tbb::global_control>(std::in_place, tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(jobs));
}

void sayLeftOut(const io::LogTally& tally, const Voice& voice) {
  for (const auto& [what, count] : tally.refused)
    voice.say("left out: " + std::to_string(count) + " x " + what);
  for (const auto& [what, count] : tally.skipped)
    voice.detail("not a measurement: " + std::to_string(count) + " x " + what);
}

void requireWhole(const Inputs& inputs, const Replayed& result) {
  if (!result.log_end.damaged) return;
  throw DataError(Complaint{
      .what = "the log is damaged; everything before the damage was used",
      .place = {.file = inputs.config.log->file.string()},
      .got = std::to_string(result.log_end.objects) + " whole objects, damage after byte " +
             std::to_string(result.log_end.byte) + " (" + result.log_end.message + ")",
      .suggestion = "copy the log again from its source; the results so far are complete up to there"});
}

void requireTruthOfThatTime(const Inputs& inputs, const Replayed& result) {
  if (!inputs.truth || inputs.truth->poses.empty()) return;
  const Duration offset = durationFromSeconds(inputs.config.evaluation.truth_time_offset);
  const Span truth{inputs.truth->poses.front().stamp + offset, inputs.truth->poses.back().stamp + offset};
  requireCommonTime(truth, {result.first, result.last}, "the log");
}

ExitCode runReplay(const Options& options, const Voice& voice) {
  const Inputs inputs = loadInputs(options.inputs);
  if (options.dry_run) {
    print(io::resolvedYaml(inputs.config));
    voice.say("nothing was run: the configuration, the map and the truth are in order");
    return ExitCode::Ok;
  }
  refuseUnknownMetrics(options.outputs.requirements, inputs.config);
  const auto folder = openRunFolder(options.outputs);
  const auto viewer = folder ? viewerTemplate(options.interface) : std::nullopt;
  watchInterrupts();
  const auto limit = limitTo(options.jobs);
  Replayed result = [&] {
    const bool knows_end = inputs.truth && inputs.truth->poses.size() > 1;
    ProgressLine line(voice, "replay",
                      knows_end ? std::optional(inputs.truth->poses.back().stamp) : std::nullopt);
    const auto go_on = [&](std::uint64_t count, Stamp stamp) {
      line.draw(count, stamp);
      return !interrupted();
    };
    return replayed(inputs, folder ? &*folder : nullptr, go_on, Keep::ForTheReport);
  }();
  if (!result.source_note.empty()) voice.say(result.source_note);
  sayLeftOut(result.tally, voice);
  const eval::RunSummary summary = summaryOf(inputs, result);
  if (folder) writeRun(*folder, inputs, summary, extrasOf(inputs, result), viewer);
  show(summary, options.outputs, folder ? &*folder : nullptr, voice);
  if (result.interrupted) {
    voice.warn("interrupted: the results cover the log up to where it was stopped");
    return ExitCode::Interrupted;
  }
  requireTruthOfThatTime(inputs, result);
  checkRequirements(summary, options.outputs.requirements, voice);
  requireWhole(inputs, result);
  return ExitCode::Ok;
}

}  // namespace

void addReplay(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand("replay", "Run a log through the estimators of a configuration");
  auto options = std::make_shared<Options>();
  addInputs(*verb, options->inputs);
  addOutputs(*verb, options->outputs);
  verb->add_option("--interface", options->interface,
                   "Folder of the built browser interface, for viewer.html in --out");
  verb->add_option("--jobs", options->jobs, "Estimators at the same time (default: one a core)")
      ->check(CLI::Range(0, 4096));
  verb->add_flag("--dry-run", options->dry_run,
                 "Check everything, print the resolved configuration, run nothing");
  addVoice(*verb, *verbs.voice);
  verb->callback([options, verbs] { *verbs.code = runReplay(*options, *verbs.voice); });
}

}  // namespace pos::app
