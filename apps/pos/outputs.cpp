#include "outputs.hpp"

#include <nlohmann/json.hpp>

#include "pos/core/error.hpp"
#include "pos/eval/requirement.hpp"
#include "pos/io/scenario_yaml.hpp"
#include "pos/io/sha256.hpp"
#include "pos/report/comparison.hpp"
#include "pos/report/face_files.hpp"
#include "pos/report/figures.hpp"
#include "pos/report/html.hpp"
#include "pos/report/summary_json.hpp"
#include "pos/report/text.hpp"
#include "viewer_page.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

nlohmann::ordered_json inputEntry(const char* role, const fs::path& file) {
  return {{"role", role}, {"file", file.string()}, {"sha256", io::sha256OfFile(file)}};
}

/// Everything needed to repeat the run: versions, inputs with their checksums, seed, resolved configuration.
std::string runJson(const Inputs& inputs) {
  const io::RunConfig& config = inputs.config;
  nlohmann::ordered_json run;
  run["run"] = config.name;
  run["pos_version"] = version();
  run["git"] = gitHash();
  run["seed"] = config.seed;
  run["inputs"] = nlohmann::ordered_json::array();
  for (const InputFile& input : inputFiles(inputs))
    run["inputs"].push_back(inputEntry(input.role.c_str(), input.file));
  run["config"] = io::resolvedYaml(config);
  if (config.scenario) run["scenario"] = io::resolvedYaml(*inputs.scenario);
  return run.dump(2) + "\n";
}

}  // namespace

void addOutputs(CLI::App& verb, OutputOptions& options) {
  verb.add_flag("--json", options.json, "Print the summary as JSON on standard output");
  verb.add_option("--out", options.folder, "Folder for run.json, trajectories, summary.json and report.html");
  verb.add_flag("--force", options.force, "Replace the files of an earlier run in --out");
  verb.add_option("--require", options.requirements,
                  "Limit to keep, e.g. 'p95_xy<1.0'; exit code 4 when missed")
      ->take_all()
      ->allow_extra_args(false);
}

std::optional<io::RunFolder> openRunFolder(const OutputOptions& options) {
  if (options.folder.empty()) return std::nullopt;
  return io::RunFolder::create(options.folder,
                               options.force ? io::ExistingRun::Replace : io::ExistingRun::Refuse);
}

void writeRunJson(const io::RunFolder& folder, const Inputs& inputs) {
  writeFile(folder.runJson(), runJson(inputs));
}

void writeRun(const io::RunFolder& folder, const Inputs& inputs, const eval::RunSummary& summary,
              report::ReportExtras extras, const std::optional<std::string>& viewer) {
  if (viewer) extras.viewer = kViewerFile;
  writeRunJson(folder, inputs);
  writeFile(folder.summaryJson(), report::summaryJson(summary));
  writeFile(folder.reportHtml(), report::reportHtml(summary, io::resolvedYaml(inputs.config), extras));
  if (viewer) writeViewer(folder.path(), inputs, *viewer);
  const fs::path figures = folder.path() / "figures";
  fs::create_directories(figures);
  for (const report::NamedFigure& figure : report::figures(summary))
    writeFile(figures / (figure.name + ".svg"), figure.svg);
  for (const report::NamedFigure& picture : extras.pictures)
    writeFile(figures / (picture.name + ".svg"), picture.svg);
  for (const report::NamedFigure& figure : report::faceFigures(extras.faces))
    writeFile(figures / (figure.name + ".svg"), figure.svg);
  for (const auto& [name, face] : extras.faces) {
    writeFile(folder.path() / (name + ".face_track.csv"), report::faceTrackCsv(face));
    writeFile(folder.path() / (name + ".face_bend.csv"), report::faceProfileCsv(face));
    writeFile(folder.path() / (name + ".face_creep.csv"), report::faceOperationsCsv(face));
  }
}

void show(const eval::RunSummary& summary, const OutputOptions& options, const io::RunFolder* folder,
          const Voice& voice) {
  for (const std::string& warning : report::warnings(summary)) voice.say("note: " + warning);
  if (options.json) {
    print(report::summaryJson(summary));
  } else {
    print(report::comparisonTable(summary));
  }
  if (folder != nullptr) voice.say("report: " + folder->reportHtml().string());
}

void requireCommonTime(const Span& truth, const Span& other, const std::string& what) {
  if (truth.from <= other.to && truth.to >= other.from) return;
  const auto text = [](const Span& span) {
    return report::momentText(span.from) + " to " + report::momentText(span.to);
  };
  throw DataError(
      Complaint{.what = "the truth and " + what + " have no moment in common, so nothing could be judged",
                .got = "truth " + text(truth) + "; " + what + " " + text(other),
                .expected = "two recordings of the same time, on the same clock",
                .suggestion = "name the truth of this log; where only the clocks differ, give the offset "
                              "(evaluation.truth_time_offset_s, or --time-offset-s of pos evaluate)"});
}

void checkRequirements(const eval::RunSummary& summary, const std::vector<std::string>& requirements,
                       const Voice& voice) {
  std::vector<eval::RequirementResult> results;
  for (const std::string& text : requirements) {
    for (const eval::RequirementResult& result : eval::check(eval::parseRequirement(text, summary), summary))
      results.push_back(result);
  }
  requireAllPassed(results, voice);
}

void requireAllPassed(const std::vector<eval::RequirementResult>& results, const Voice& voice) {
  std::string missed;
  std::size_t count = 0;
  for (const eval::RequirementResult& result : results) {
    if (result.passed) voice.say(result.line);
    if (result.passed) continue;
    missed += (missed.empty() ? "" : "\n            ") + result.line;
    ++count;
  }
  if (count == 0) return;
  throw RequirementMissed(Complaint{
      .what = std::to_string(count) + " of " + std::to_string(results.size()) + " required limits missed",
      .got = missed});
}

void refuseUnknownMetrics(const std::vector<std::string>& requirements, const io::RunConfig& config) {
  eval::RunSummary nothing_yet;
  for (const io::EstimatorEntry& entry : config.estimators) {
    nothing_yet.estimators.emplace_back();
    nothing_yet.estimators.back().name = entry.name;
    if (config.intervals) nothing_yet.estimators.back().intervals.emplace();
  }
  for (const std::string& text : requirements) {
    if (!eval::isOfASensor(text)) (void)eval::parseRequirement(text, nothing_yet);
  }
}

}  // namespace pos::app
