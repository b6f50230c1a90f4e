/// The scene of a lock log as JSON.

#include <nlohmann/json.hpp>

#include "pos/core/error.hpp"
#include "pos/io/lock_log.hpp"

namespace pos::io {
namespace {

using Json = nlohmann::ordered_json;
using namespace interval;

constexpr const char* kFormat = "pos.locks.scene/1";
constexpr std::array kStopKinds{"niche", "on_road", "depot"};

struct RuleKey {
  const char* key;
  double LockRules::*field;
};
constexpr std::array kRules{RuleKey{"footprint_sigmas", &LockRules::footprint_sigmas},
                            RuleKey{"release_sigmas", &LockRules::release_sigmas},
                            RuleKey{"release_margin_m", &LockRules::release_margin},
                            RuleKey{"stale_after_s", &LockRules::stale_after},
                            RuleKey{"steady_for_s", &LockRules::steady_for},
                            RuleKey{"jump_sigmas", &LockRules::jump_sigmas},
                            RuleKey{"speed_error_m_per_s", &LockRules::speed_error},
                            RuleKey{"jump_slack_m", &LockRules::jump_slack},
                            RuleKey{"gap_between_m", &LockRules::gap_between},
                            RuleKey{"patience_s", &LockRules::patience},
                            RuleKey{"aging_s", &LockRules::aging}};

Json wayJson(const Way& way) {
  Json sections = Json::array();
  for (const WaySection& s : way.sections) {
    sections.push_back(
        {{"section", s.section}, {"movement", s.movement}, {"from_m", s.from}, {"to_m", s.to}});
  }
  Json stops = Json::array();
  for (const WayStop& s : way.stops)
    stops.push_back({{"stop", s.stop}, {"at_m", s.at}, {"from_m", s.from}, {"to_m", s.to}});
  return {{"sections", std::move(sections)}, {"stops", std::move(stops)}};
}

Way wayFrom(const Json& json) {
  Way way;
  for (const Json& s : json.at("sections")) {
    way.sections.push_back({s.at("section").get<std::size_t>(), s.at("movement").get<int>(),
                            s.at("from_m").get<double>(), s.at("to_m").get<double>()});
  }
  for (const Json& s : json.at("stops")) {
    way.stops.push_back({s.at("stop").get<std::size_t>(), s.at("at_m").get<double>(),
                         s.at("from_m").get<double>(), s.at("to_m").get<double>()});
  }
  return way;
}

StopPlace::Kind stopKind(const std::string& word) {
  for (std::size_t k = 0; k < kStopKinds.size(); ++k) {
    if (word == kStopKinds[k]) return static_cast<StopPlace::Kind>(k);
  }
  throw DataError(Complaint{.what = "no stop is of that kind", .got = word});
}

LockScene sceneFrom(const Json& json) {
  if (json.at("format") != kFormat) {
    throw DataError(
        Complaint{.what = "another format", .got = json.at("format").dump(), .expected = kFormat});
  }
  LockScene scene;
  for (const RuleKey& rule : kRules) scene.rules.*rule.field = json.at("rules").at(rule.key).get<double>();
  for (const Json& s : json.at("sections")) {
    scene.site.sections.push_back({s.at("id").get<std::string>(), s.at("single_lane").get<bool>(),
                                   s.at("intervals").get<std::vector<std::size_t>>()});
  }
  for (const Json& s : json.at("stops")) {
    scene.site.stops.push_back({s.at("id").get<std::string>(), stopKind(s.at("kind").get<std::string>()),
                                s.at("length_m").get<double>(), s.at("capacity").get<int>()});
  }
  for (const Json& way : json.at("ways")) scene.ways.push_back(validated(wayFrom(way), scene.site));
  return scene;
}

}  // namespace

std::string lockSceneJson(const LockScene& scene) {
  Json json{{"format", kFormat}};
  for (const RuleKey& rule : kRules) json["rules"][rule.key] = scene.rules.*rule.field;
  json["sections"] = Json::array();
  for (const LockSection& s : scene.site.sections)
    json["sections"].push_back({{"id", s.id}, {"single_lane", s.single_lane}, {"intervals", s.intervals}});
  json["stops"] = Json::array();
  for (const StopPlace& s : scene.site.stops) {
    json["stops"].push_back({{"id", s.id},
                             {"kind", kStopKinds[static_cast<std::size_t>(s.kind)]},
                             {"length_m", s.length},
                             {"capacity", s.capacity}});
  }
  json["ways"] = Json::array();
  for (const Way& way : scene.ways) json["ways"].push_back(wayJson(way));
  return json.dump(1) + "\n";
}

LockScene lockSceneFrom(const std::string& text, const std::string& file) {
  try {
    return sceneFrom(Json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    throw DataError(
        Complaint{.what = "this is no scene of locks", .place = {.file = file}, .got = error.what()});
  } catch (const DataError& error) {
    Complaint complaint = error.complaint();
    complaint.place.file = file;
    throw DataError(complaint);
  }
}

}  // namespace pos::io
