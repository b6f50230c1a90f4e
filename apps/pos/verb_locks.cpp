/// `pos locks`: who may drive where, tried out on a map, and judged again from the log.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "common.hpp"
#include "lock_yard.hpp"
#include "pos/core/error.hpp"
#include "pos/io/files.hpp"
#include "pos/io/run_folder.hpp"
#include "pos/report/locks_html.hpp"
#include "pos/report/text.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using report::fixed;
using report::grouped;

constexpr const char* kSceneFile = "scene.json";
constexpr const char* kLogFile = "audit.csv";

struct Options {
  std::string config;
  std::vector<std::string> overrides;
  std::optional<std::uint64_t> seed;
  std::string folder;
  bool json = false;
  bool force = false;
  bool no_log = false;
};

/// Waiting times in s.
struct Waits {
  double mean = 0.0;
  double median = 0.0;
  double p95 = 0.0;
  double longest = 0.0;
};
Waits waitsOf(std::vector<double> all) {
  if (all.empty()) return {};
  std::sort(all.begin(), all.end());
  return {std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size()), all[all.size() / 2],
          all[all.size() * 95 / 100], all.back()};
}

Json tallyJson(const interval::AuditTally& t, const std::vector<interval::AuditFinding>& findings) {
  const Waits waits = waitsOf(t.waits);
  Json json{{"events", t.events},
            {"requests", t.requests},
            {"granted", t.granted},
            {"granted_at_once", t.granted_at_once},
            {"waiting_s",
             {{"mean", waits.mean}, {"median", waits.median}, {"p95", waits.p95}, {"max", waits.longest}}},
            {"locks", t.locks},
            {"releases", t.releases},
            {"trespasses", t.trespasses},
            {"doubts", t.doubts},
            {"silences", t.stale},
            {"restarts", t.restarts},
            {"overrides", t.overrides},
            {"rejected", t.rejected},
            {"findings", Json::array()}};
  for (const interval::AuditFinding& f : findings) {
    json["findings"].push_back(
        {{"stamp_s", secondsSinceOrigin(f.stamp)}, {"vehicle", f.vehicle}, {"what", f.what}});
  }
  return json;
}

Json resultJson(const traffic::TrafficResult& r, const io::LocksConfig& config) {
  Json json{{"format", "pos.locks/1"},
            {"run", config.name},
            {"seed", config.seed},
            {"lock_success_share", r.lockSuccess()},
            {"deadlocks", r.deadlocks},
            {"jam", r.jam},
            {"ways_finished", r.ways_finished},
            {"simulated_s", r.simulated},
            {"driven_m", r.driven}};
  json["opposing_s"] = config.traffic ? Json(r.opposing) : Json(nullptr);  // recordings have no truth here
  json["audit"] = tallyJson(r.tally, r.findings);
  return json;
}

std::vector<report::LockFigure> figuresOf(const traffic::TrafficResult& r, const io::LocksConfig& config) {
  const interval::AuditTally& t = r.tally;
  const Waits waits = waitsOf(t.waits);
  const double at_once =
      t.granted > 0 ? static_cast<double>(t.granted_at_once) / static_cast<double>(t.granted) : 0.0;
  std::vector<report::LockFigure> figures{
      {"vehicles", grouped(config.traffic ? static_cast<unsigned long long>(config.traffic->vehicles)
                                          : config.vehicles.size())},
      {"requests", grouped(t.requests)},
      {"granted", grouped(t.granted) + " (" + report::percent(at_once) + " at once)"},
      {"waiting mean", fixed(waits.mean, 1) + " s"},
      {"waiting median", fixed(waits.median, 1) + " s"},
      {"waiting 95 %", fixed(waits.p95, 1) + " s"},
      {"waiting longest", fixed(waits.longest, 0) + " s"},
      {"locks", grouped(t.locks)},
      {"locks without a finding", r.findings.empty() ? "100 %" : report::percent(r.lockSuccess())},
      {"audit findings", grouped(r.findings.size())},
      {"deadlocks", grouped(r.deadlocks)},
      {"trespasses", grouped(t.trespasses)},
      {"faults met", grouped(t.doubts) + " doubts, " + grouped(t.stale) + " silences, " +
                         grouped(t.restarts) + " restarts, " + grouped(t.overrides) + " overrides, " +
                         grouped(t.rejected) + " rejected events"},
      {"ways finished", grouped(r.ways_finished)},
      {"driven", fixed(r.driven / 1000.0, 1) + " km in " + fixed(r.simulated / 3600.0, 2) + " h"}};
  if (config.traffic)
    figures.insert(figures.begin() + 10, {"opposing footprints (true)", grouped(r.opposing) + " s"});
  return figures;
}

std::vector<std::string> warningsOf(const traffic::TrafficResult& r) {
  std::vector<std::string> all;
  if (r.opposing > 0) all.push_back("Bodies opposed each other for " + grouped(r.opposing) + " s.");
  if (r.deadlocks > 0) all.push_back("Nobody could go on any more: " + r.jam);
  for (std::size_t i = 0; i < std::min<std::size_t>(r.findings.size(), 20); ++i) {
    all.push_back(fixed(secondsSinceOrigin(r.findings[i].stamp), 1) + " s, vehicle " +
                  std::to_string(r.findings[i].vehicle) + ": " + r.findings[i].what);
  }
  if (r.findings.size() > 20) all.push_back("and " + grouped(r.findings.size() - 20) + " findings more");
  return all;
}

void show(const std::vector<report::LockFigure>& figures, const std::vector<std::string>& warnings) {
  std::string text;
  for (const report::LockFigure& f : figures)
    text += f.name + std::string(f.name.size() < 28 ? 28 - f.name.size() : 1, ' ') + f.value + "\n";
  for (const std::string& warning : warnings) text += "! " + warning + "\n";
  print(text);
}

ExitCode runLocks(const Options& options, const Voice& voice) {
  io::LocksConfig config = io::loadLocksConfig(options.config, options.overrides, mrptShare());
  if (options.seed) config.seed = *options.seed;
  if (config.traffic) config.traffic->seed = config.seed;
  const LockYard yard(config);
  std::optional<io::RunFolder> folder;
  if (!options.folder.empty()) {
    folder = io::RunFolder::create(options.folder,
                                   options.force ? io::ExistingRun::Replace : io::ExistingRun::Refuse);
  }
  std::optional<io::LockLogWriter> log;
  if (folder && !options.no_log) log.emplace(folder->path() / kLogFile, yard.ways());
  LockDiagram diagram(yard, config);
  const traffic::TrafficWatch watch{.event =
                                        [&](const auto& event, const auto& records) {
                                          if (log) log->write(event, records);
                                          diagram.take(event, records);
                                        },
                                    .places = [&](double t, const auto& places) { diagram.take(t, places); }};
  const traffic::TrafficResult result =
      config.traffic
          ? traffic::runTraffic(yard.locks().site(), yard.ways(), config.rules, *config.traffic, watch)
          : runRecorded(yard, config, watch);
  const std::string summary = resultJson(result, config).dump(2) + "\n";
  const auto figures = figuresOf(result, config);
  if (log) log->close();
  if (folder) {
    writeFile(folder->path() / kSceneFile, lockSceneJson(yard.scene()));
    writeFile(folder->summaryJson(), summary);
    report::LockReport page{config.name, yard.network().map().name, figures, warningsOf(result),
                            diagram.finish()};
    writeFile(folder->reportHtml(), report::locksHtml(page, io::resolvedYaml(config)));
    writeFile(folder->path() / "time_distance.svg", report::timeDistanceFigure(page.diagram).svg);
    voice.say("report: " + folder->reportHtml().string());
  }
  options.json ? print(summary) : show(figures, warningsOf(result));
  return result.findings.empty() && result.opposing == 0 && result.deadlocks == 0 ? ExitCode::Ok
                                                                                  : ExitCode::Missed;
}

ExitCode runAudit(const std::string& folder, bool json) {
  const fs::path scene_file = io::existingFile(fs::path(folder) / kSceneFile, Complaint{});
  const io::LockScene scene = io::lockSceneFrom(io::fileText(scene_file), scene_file.string());
  io::LockLogReader log(io::existingFile(fs::path(folder) / kLogFile, Complaint{}), scene.ways);
  interval::LockAudit audit(std::make_shared<const interval::LockSite>(scene.site), scene.rules);
  while (const auto step = log.next()) audit.take(step->event, step->records);
  if (json) {
    print(tallyJson(audit.tally(), audit.findings()).dump(2) + "\n");
  } else {
    traffic::TrafficResult judged{.tally = audit.tally(), .findings = audit.findings()};
    print(grouped(judged.tally.events) + " events, " + grouped(judged.tally.requests) + " requests, " +
          grouped(judged.tally.granted) + " granted, " + grouped(judged.tally.locks) + " locks, " +
          grouped(judged.findings.size()) + " findings\n");
    for (const std::string& line : warningsOf(judged)) print("! " + line + "\n");
  }
  return audit.findings().empty() ? ExitCode::Ok : ExitCode::Missed;
}

}  // namespace

void addLocks(const Verbs& verbs) {
  CLI::App* verb =
      verbs.app->add_subcommand("locks", "Try out lock occupancy with several vehicles, and audit it");
  verb->require_subcommand(1);
  CLI::App* run = verb->add_subcommand("run", "Run generated traffic, or recorded vehicles, under the locks");
  auto options = std::make_shared<Options>();
  run->add_option("config", options->config, "Configuration file (YAML)")->required();
  run->add_option("--seed", options->seed, "Seed of the traffic")->check(kWholeNumber);
  run->add_option("--set", options->overrides,
                  "key=value laid over the configuration, e.g. traffic.requests=1000")
      ->take_all()
      ->allow_extra_args(false);
  run->add_option("--out", options->folder,
                  "Folder for audit.csv, scene.json, summary.json, report.html and time_distance.svg");
  run->add_flag("--no-log", options->no_log, "Leave audit.csv out; a long run makes a large one");
  run->add_flag("--force", options->force, "Replace the files of an earlier run in --out");
  run->add_flag("--json", options->json, "Print the summary as JSON on standard output");
  addVoice(*run, *verbs.voice);
  run->callback([options, verbs] { *verbs.code = runLocks(*options, *verbs.voice); });

  CLI::App* audit =
      verb->add_subcommand("audit", "Judge the log of an earlier run again, without the engine");
  auto folder = std::make_shared<std::string>();
  auto as_json = std::make_shared<bool>(false);
  audit->add_option("folder", *folder, "Folder with audit.csv and scene.json")->required();
  audit->add_flag("--json", *as_json, "Print JSON");
  addVoice(*audit, *verbs.voice);
  audit->callback([folder, as_json, verbs] { *verbs.code = runAudit(*folder, *as_json); });
}

}  // namespace pos::app
