/// `pos calibrate latency`: how late a sensor's stamps are, found against another sensor of the same log. No
/// truth.

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

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
  io::RawlogReader reader(log.string());
  while (const auto m = reader.next()) {
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

}  // namespace

void addCalibrate(const Verbs& verbs) {
  CLI::App* verb =
      verbs.app->add_subcommand("calibrate", "Find a sensor's constants from a log, without any truth");
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
}

}  // namespace pos::app
