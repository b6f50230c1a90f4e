/// `pos evaluate`: trajectories against a truth, whoever made them.

#include <memory>

#include "outputs.hpp"
#include "pos/core/error.hpp"
#include "pos/io/trajectory_io.hpp"
#include "pos/report/html.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> trajectories;
  std::string truth;
  std::string truth_format = "tum";
  std::string align = "none";
  double time_offset = 0.0;
  double max_gap = 1.0;
  double truth_sigma = 0.0;
  OutputOptions outputs;
};

/// Our own table starts with a header; everything else is read as TUM.
std::vector<Estimate> readTrajectory(const fs::path& path) {
  return path.extension() == ".csv" ? io::readEstimateCsv(path) : io::readTum(path);
}

eval::AlignmentMode alignmentMode(const std::string& word) {
  for (const eval::AlignmentMode mode : eval::kAlignmentModes) {
    if (eval::name(mode) == word) return mode;
  }
  throw ContractError("alignment mode was checked before");
}

void requireEstimates(const std::vector<Estimate>& estimates, const std::string& path) {
  if (!estimates.empty()) return;
  throw DataError(Complaint{.what = "the trajectory holds no pose",
                            .place = {.file = path},
                            .suggestion = "check that the run that wrote it got as far as a first estimate"});
}

ExitCode runEvaluate(const Options& options, const Voice& voice) {
  const Truth truth =
      options.truth_format == "euroc" ? io::readEurocTruth(options.truth) : io::readTumTruth(options.truth);
  eval::EvaluationOptions evaluation;
  evaluation.alignment = alignmentMode(options.align);
  evaluation.association.time_offset = durationFromSeconds(options.time_offset);
  evaluation.association.max_truth_gap = durationFromSeconds(options.max_gap);
  evaluation.truth_sigma = options.truth_sigma;

  eval::RunSummary summary;
  summary.run = "evaluate";
  summary.log = fs::path(options.truth).filename().string();
  summary.has_truth = true;
  summary.start = truth.poses.front().stamp;
  summary.end = truth.poses.back().stamp;
  summary.truth_path = eval::pathOf(truth, summary.start);
  for (const std::string& path : options.trajectories) {
    eval::EstimatorRecord record;
    record.name = fs::path(path).stem().string();
    record.type = "trajectory";
    record.estimates = readTrajectory(path);
    requireEstimates(record.estimates, path);
    const Stamp first = record.estimates.front().stamp + evaluation.association.time_offset;
    const Stamp last = record.estimates.back().stamp + evaluation.association.time_offset;
    requireCommonTime({summary.start, summary.end}, {first, last}, path);
    summary.estimators.push_back(eval::summarise(record, &truth, summary.start, evaluation));
  }
  if (!options.outputs.folder.empty()) {
    const auto folder = openRunFolder(options.outputs);
    writeFile(folder->reportHtml(), report::reportHtml(summary, "evaluation of recorded trajectories"));
    show(summary, options.outputs, &*folder, voice);
  } else {
    show(summary, options.outputs, nullptr, voice);
  }
  checkRequirements(summary, options.outputs.requirements, voice);
  return ExitCode::Ok;
}

}  // namespace

void addEvaluate(const Verbs& verbs) {
  CLI::App* verb =
      verbs.app->add_subcommand("evaluate", "Judge recorded trajectories against reference poses");
  auto options = std::make_shared<Options>();
  verb->add_option("trajectory", options->trajectories,
                   "TUM files (8 or 20 columns) or <estimator>.csv of a run folder")
      ->required();
  verb->add_option("--truth", options->truth, "Reference poses")->required();
  verb->add_option("--truth-format", options->truth_format, "Format of --truth")
      ->check(CLI::IsMember({"tum", "euroc"}));
  verb->add_option("--align", options->align,
                   "Lay the estimate on the truth first (default: none, the map frame counts)")
      ->check(CLI::IsMember({"none", "origin", "se2", "se3", "posyaw"}));
  verb->add_option("--time-offset-s", options->time_offset,
                   "Added to the estimates' stamps before the truth is asked");
  verb->add_option("--max-gap-s", options->max_gap, "Longest gap of the truth that is interpolated over");
  verb->add_option("--truth-sigma-m", options->truth_sigma,
                   "How good the truth is, per axis (default 0); enters the NEES only")
      ->check(CLI::Range(0.0, 1000.0));
  addOutputs(*verb, options->outputs);
  addVoice(*verb, *verbs.voice);
  verb->callback([options, verbs] { *verbs.code = runEvaluate(*options, *verbs.voice); });
}

}  // namespace pos::app
