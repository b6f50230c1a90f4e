/// `pos calibrate latency`: how late a sensor's stamps are, found against another sensor of the same log,
/// without truth. `pos calibrate ranges`: what the radio links read too long, found at known poses.

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "calibrate_ranges.hpp"
#include "common.hpp"
#include "inputs.hpp"
#include "pos/core/error.hpp"
#include "pos/eval/alignment.hpp"
#include "pos/eval/latency.hpp"
#include "pos/map/geodesy.hpp"
#include "replay.hpp"

namespace pos::app {
namespace {

struct Options {
  InputOptions inputs;
  std::string estimator;
  double window = 1.0;
  bool json = false;
};

/// The satellite fixes of the log as a level path about the first fix.
std::vector<eval::TimedPosition> satellitePath(const std::filesystem::path& log) {
  std::vector<eval::TimedPosition> path;
  std::optional<map::LocalFrame> frame;
  const auto reader = io::openLog(log.string()).reader;
  while (const auto m = reader->next()) {
    const auto* fix = std::get_if<GnssFix>(&m->reading);
    if (fix == nullptr || fix->quality == GnssFix::Quality::None) continue;
    if (!frame) frame.emplace(map::GeodeticOrigin{fix->latitude, fix->longitude, fix->altitude, 0.0});
    path.push_back({m->stamp, frame->fromGeodetic(fix->latitude, fix->longitude, fix->altitude).head<2>()});
  }
  return path;
}

std::vector<eval::TimedPosition> estimatedPath(Inputs inputs, const std::string& wanted) {
  inputs.truth.reset();
  if (wanted.empty() && inputs.config.estimators.size() > 1) inputs.config.estimators.resize(1);
  if (!wanted.empty()) {
    std::erase_if(inputs.config.estimators, [&](const io::EstimatorEntry& e) { return e.name != wanted; });
    if (inputs.config.estimators.empty()) {
      throw UsageError(
          Complaint{.what = "the configuration has no such estimator", .key = "--estimator", .got = wanted});
    }
  }
  const Replayed result = replayed(inputs, nullptr, [](std::uint64_t, Stamp) { return true; });
  std::vector<eval::TimedPosition> path;
  for (const Estimate& e : result.records.front().estimates)
    path.push_back({e.stamp, e.T_map_body.translation.head<2>()});
  return path;
}

ExitCode runLatency(const Options& options, const Voice& voice) {
  const Inputs inputs = loadInputs(options.inputs);
  if (!inputs.config.log) {
    throw UsageError(
        Complaint{.what = "a latency is found in a recording, and the configuration has a scenario",
                  .place = {.file = options.inputs.config},
                  .key = "scenario",
                  .suggestion = "write the scenario's log with pos simulate and name it with --log"});
  }
  const auto reference = satellitePath(inputs.config.log->file);
  if (reference.size() < 10) {
    throw DataError(
        Complaint{.what = "the log has too few satellite fixes to calibrate against",
                  .place = {.file = inputs.config.log->file.string()},
                  .got = std::to_string(reference.size()) + " fixes",
                  .expected = "at least 10, while the vehicle moves",
                  .suggestion = "record a stretch at the surface with a satellite receiver switched on"});
  }
  const auto estimate = estimatedPath(inputs, options.estimator);
  const eval::LatencyFit fit = eval::fittedLatency(estimate, reference, options.window);
  if (options.json) {
    print(nlohmann::ordered_json{{"latency_s", fit.latency},
                                 {"residual_m", fit.residual},
                                 {"residual_without_m", fit.residual_at_zero},
                                 {"pairs", fit.pairs}}
              .dump(2) +
          "\n");
  } else {
    char text[160];
    std::snprintf(text, sizeof text, "latency: {value_s: %.3f}\n", fit.latency);
    print(text);
    std::snprintf(text, sizeof text, "residual %.3f m with it, %.3f m without, over %zu pairs", fit.residual,
                  fit.residual_at_zero, fit.pairs);
    voice.say(text);
  }
  return ExitCode::Ok;
}

struct RangeOptions {
  InputOptions inputs;
  RangeCalibrationRequest request;
  std::vector<double> still;
  std::string out;
};

ExitCode runRanges(RangeOptions options, const Voice& voice) {
  io::RunConfig config = loadConfig(options.inputs);
  for (io::EstimatorEntry& entry : config.estimators) {  // an older table is what is to be replaced
    if (auto* dual = std::get_if<estimation::DualUwbConfig>(&entry.config)) dual->range_bias_table.clear();
  }
  if (!config.log) {
    throw UsageError(Complaint{.what = "no log to calibrate from",
                               .key = "log.file",
                               .suggestion = "name it in the configuration or with --log"});
  }
  if (!options.still.empty()) {
    options.request.still = Pose2{options.still[0], options.still[1], radians(options.still[2])};
  }
  const RangeCalibrationOutcome outcome = calibratedRanges(loadInputs(std::move(config)), options.request);
  const std::string table = io::rangeBiasYaml(outcome.table);
  if (options.out.empty()) {
    print(table);
  } else {
    writeFile(options.out, table);
  }
  char text[200];
  std::snprintf(text, sizeof text, "%zu links from %d ranges, %d left out as outliers; residuals %.3f m",
                outcome.table.links.size(), outcome.samples, outcome.outliers, outcome.residual_sigma);
  voice.say(text);
  std::snprintf(text, sizeof text, "of these %.3f m are new in every reading, %.3f m last %.1f s",
                outcome.table.errors->range_sigma, outcome.table.errors->lasting_sigma,
                outcome.table.errors->lasting_time);
  voice.say(text);
  if (outcome.table.motion) {
    std::snprintf(text, sizeof text,
                  "turns about a point %.3f m behind the body frame, course %.2f deg from its x axis",
                  outcome.table.motion->centre_x, degrees(outcome.table.motion->course_offset));
    voice.say(text);
    std::snprintf(text, sizeof text, "speed and yaw rate wander by %.2f m/s and %.1f deg/s per sqrt(s)",
                  outcome.table.motion->acceleration_density,
                  degrees(outcome.table.motion->yaw_acceleration_density));
    voice.say(text);
  }
  return ExitCode::Ok;
}

void addRanges(CLI::App& calibrate, const Verbs& verbs) {
  CLI::App* ranges = calibrate.add_subcommand(
      "ranges",
      "What every tag and anchor read too long, from known poses (--truth) or standing still (--still)");
  auto options = std::make_shared<RangeOptions>();
  addInputs(*ranges, options->inputs);
  ranges->add_option("--estimator", options->request.estimator,
                     "Estimator whose tags are meant (default: the first of type dual_uwb)");
  ranges->add_option("--first-s", options->request.first, "Use this much from the beginning only")
      ->check(CLI::Range(0.1, 1e6));
  ranges->add_option("--still", options->still, "The vehicle stands here: X_M Y_M YAW_DEG")->expected(3);
  ranges
      ->add_option("--shift-sigma-m", options->request.shift_sigma,
                   "How far a tag's electrical place may lie from its mount (default 0.02)")
      ->check(CLI::Range(0.0, 1.0));
  ranges->add_option("--out", options->out, "File for the table (default: standard output)");
  addVoice(*ranges, *verbs.voice);
  ranges->callback([options, verbs] { *verbs.code = runRanges(*options, *verbs.voice); });
}

}  // namespace

void addCalibrate(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand("calibrate", "Find a sensor's constants from a log");
  verb->require_subcommand(1);
  CLI::App* latency =
      verb->add_subcommand("latency", "How late the ranges are, against the satellite fixes of the same log");
  auto options = std::make_shared<Options>();
  addInputs(*latency, options->inputs);
  latency->add_option("--estimator", options->estimator,
                      "Estimator that turns ranges into positions (default: the first)");
  latency->add_option("--window-s", options->window, "Latencies from minus to plus this are tried")
      ->check(CLI::Range(0.1, 10.0));
  latency->add_flag("--json", options->json, "Print JSON");
  addVoice(*latency, *verbs.voice);
  latency->callback([options, verbs] { *verbs.code = runLatency(*options, *verbs.voice); });
  addRanges(*verb, verbs);
}

}  // namespace pos::app
