/// `pos info`: what is in a log.

#include <memory>
#include <nlohmann/json.hpp>

#include "common.hpp"
#include "pos/core/error.hpp"
#include "pos/io/log_info.hpp"

namespace pos::app {
namespace {

nlohmann::ordered_json toJson(const io::LogInfo& info) {
  nlohmann::ordered_json json{{"log", info.path},
                              {"measurements", info.measurements},
                              {"duration_s", seconds(info.duration())},
                              {"first_s", secondsSinceOrigin(info.first)},
                              {"pairs", info.pairs},
                              {"damaged", info.end.damaged},
                              {"objects", info.end.objects},
                              {"byte", info.end.byte}};
  for (const io::SensorInfo& s : info.sensors) {
    json["sensors"].push_back({{"label", s.label},
                               {"kind", s.kind},
                               {"count", s.count},
                               {"rate_hz", s.rate},
                               {"largest_gap_s", seconds(s.largest_gap)}});
  }
  for (const io::AnchorInfo& a : info.anchors) {
    json["anchors"].push_back({{"id", a.id},
                               {"count", a.count},
                               {"range_min_m", a.range_min},
                               {"range_median_m", a.range_median},
                               {"range_max_m", a.range_max}});
  }
  json["skipped"] = info.tally.skipped;
  json["refused"] = info.tally.refused;
  return json;
}

ExitCode runInfo(const std::vector<std::string>& logs, bool as_json) {
  bool damaged = false;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& log : logs) {
    const io::LogInfo info = io::logInfo(log);
    damaged = damaged || info.end.damaged;
    if (as_json) {
      all.push_back(toJson(info));
    } else {
      print(io::toText(info) + (logs.size() > 1 ? "\n" : ""));
    }
  }
  if (as_json) {
    print(
        (logs.size() == 1 ? all.front() : all).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
        "\n");
  }
  return damaged ? ExitCode::Data : ExitCode::Ok;
}

}  // namespace

void addInfo(const Verbs& verbs) {
  CLI::App* verb = verbs.app->add_subcommand("info", "Say what is in a log");
  auto logs = std::make_shared<std::vector<std::string>>();
  auto as_json = std::make_shared<bool>(false);
  verb->add_option("log", *logs, "Logs: rawlogs, MCAP files, packed copies")->required();
  verb->add_flag("--json", *as_json, "Print JSON");
  addVoice(*verb, *verbs.voice);
  verb->callback([=] { *verbs.code = runInfo(*logs, *as_json); });
}

}  // namespace pos::app
