/// `pos replay`: a log through several estimators at once, judged against the truth.

#include <unistd.h>
#include <csignal>

#include <cstdio>
#include <memory>

#include "outputs.hpp"
#include "pos/core/error.hpp"
#include "pos/report/comparison.hpp"
#include "replay.hpp"

namespace pos::app {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void onInterrupt(int) {
  interrupted = 1;
}

struct Options {
  InputOptions inputs;
  OutputOptions outputs;
  bool dry_run = false;
};

/// How far the replay is, on a terminal only; the share of the log's time is known once the truth tells its
/// length.
class ProgressLine {
 public:
  ProgressLine(const Voice& voice, const std::optional<Truth>& truth)
      : shown_(!voice.quiet && isatty(STDERR_FILENO) != 0) {
    if (truth && truth->poses.size() > 1) end_ = truth->poses.back().stamp;
  }
  ~ProgressLine() {
    if (drawn_) std::fprintf(stderr, "\r\033[K");
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ProgressLine(ProgressLine&&) = delete;
  ProgressLine& operator=(ProgressLine&&) = delete;

  void draw(std::uint64_t measurements, Stamp stamp) {
    if (!shown_) return;
    if (!start_) start_ = stamp;
    drawn_ = true;
    const double done = seconds(stamp - *start_);
    const double whole = end_ ? seconds(*end_ - *start_) : 0.0;
    const double share = whole > 0.0 ? std::min(1.0, done / whole) : 0.0;
    const auto filled = static_cast<std::size_t>(30.0 * share);
    const std::string bar =
        whole > 0.0 ? "[" + std::string(filled, '=') + std::string(30 - filled, ' ') + "] " : "";
    std::fprintf(stderr, "\r\033[Kreplay %s%.0f s of log, %llu measurements", bar.c_str(), done,
                 static_cast<unsigned long long>(measurements));
  }

 private:
  bool shown_;
  bool drawn_ = false;
  std::optional<Stamp> start_;
  std::optional<Stamp> end_;
};

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
  std::vector<std::string> names;
  for (const io::EstimatorEntry& entry : inputs.config.estimators) names.push_back(entry.name);
  refuseUnknownMetrics(options.outputs.requirements, names);
  const auto folder = openRunFolder(options.outputs);
  std::signal(SIGINT, onInterrupt);
  Replayed result = [&] {
    ProgressLine line(voice, inputs.truth);
    return replayed(inputs, folder ? &*folder : nullptr, [&](std::uint64_t count, Stamp stamp) {
      line.draw(count, stamp);
      return interrupted == 0;
    });
  }();
  sayLeftOut(result.tally, voice);
  const eval::RunSummary summary = summaryOf(inputs, result);
  if (folder) writeRun(*folder, inputs, summary);
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
  verb->add_flag("--dry-run", options->dry_run,
                 "Check everything, print the resolved configuration, run nothing");
  addVoice(*verb, *verbs.voice);
  verb->callback([options, verbs] { *verbs.code = runReplay(*options, *verbs.voice); });
}

}  // namespace pos::app
