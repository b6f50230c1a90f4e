#include "serve_answers.hpp"

#include <nlohmann/json.hpp>

#include "pos/core/error.hpp"
#include "pos/io/background.hpp"
#include "pos/io/files.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/text.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using serve::RequestError;

Answer json(std::string body) {
  return {.body = std::move(body)};
}

[[noreturn]] void notThere(const std::string& what) {
  throw RequestError(404, "not_there", Complaint{.what = what});
}

Answer fileOf(const Site& site, const char* name, const char* type) {
  const fs::path* folder = site.session.folder();
  if (folder == nullptr || !fs::is_regular_file(*folder / name))
    notThere(std::string("there is no ") + name + " here");
  return {.type = type, .body = io::fileText(*folder / name)};
}

serve::MapService& mapOf(const Site& site) {
  if (site.map == nullptr) notThere("there is no map file here");
  return *site.map;
}

Answer mapAnswer(const Site& site) {
  serve::MapService::Version version = mapOf(site).saved();
  return {.type = "application/geo+json",
          .body = std::move(version.geojson),
          .headers = {{"Cache-Control", "no-store"}, {"ETag", version.version}}};
}

Answer backgroundAnswer(const Site& site) {
  const fs::path& file = mapOf(site).file();
  std::optional<Asset> picture = backgroundOf(file);
  if (!picture) notThere("the map has no background");
  return {.type = std::move(picture->type), .body = std::move(picture->bytes)};
}

std::vector<serve::Column> columnsIn(const serve::Target& target) {
  std::vector<serve::Column> columns;
  const auto found = target.query.find("columns");
  if (found == target.query.end()) return columns;
  for (std::size_t begin = 0; begin <= found->second.size();) {
    const std::size_t end = std::min(found->second.find(',', begin), found->second.size());
    const std::string name = found->second.substr(begin, end - begin);
    const auto column = serve::columnOf(name);
    if (!column || columns.size() == serve::kColumns) {
      throw serve::badRequest(
          Complaint{.what = "a track has no such column", .key = "columns", .got = name.substr(0, 80)});
    }
    columns.push_back(*column);
    begin = end + 1;
  }
  return columns;
}

std::string columnsText(const std::vector<serve::Column>& columns) {
  std::string text;
  for (std::size_t i = 0; i < (columns.empty() ? serve::kColumns : columns.size()); ++i) {
    const std::size_t column = columns.empty() ? i : static_cast<std::size_t>(columns[i]);
    text += (i > 0 ? "," : "") + std::string(serve::columnNames()[column]);
  }
  return text;
}

Answer trackAnswer(const Site& site, const serve::Target& target) {
  serve::requireOnly(target, {"from_s", "to_s", "points", "columns"});
  const serve::TrackWindow window{.from = serve::stampOf(target, "from_s"),
                                  .to = serve::stampOf(target, "to_s"),
                                  .points = serve::countOf(target, "points", 2, 2'000'000).value_or(20000),
                                  .columns = columnsIn(target)};
  return {.type = "application/octet-stream",
          .body = site.session.stage().packed(target.path[2], window),
          .headers = {{"Cache-Control", "no-store"}, {"X-Pos-Columns", columnsText(window.columns)}}};
}

Answer eventsAnswer(const Site& site, const serve::Target& target) {
  serve::requireOnly(target, {"after", "limit"});
  const std::size_t after = serve::countOf(target, "after", 0, 1ULL << 40).value_or(0);
  const std::size_t limit = serve::countOf(target, "limit", 1, 10000).value_or(1000);
  return json(site.session.stage().eventsJson(after, limit));
}

Answer stateAnswer(const Site& site, const serve::Target& target) {
  serve::requireOnly(target, {"at_s"});
  const auto stamp = serve::stampOf(target, "at_s");
  if (!stamp) return json(site.ticker.state());
  const serve::Show show = site.session.showAt(*stamp);
  return json(serve::withSeq(0, serve::stateBody(show, site.session.stage().scenery().names)));
}

Answer apiAnswer(const Site& site, const serve::Target& target) {
  if (target.path.size() == 3 && target.path[1] == "tracks") return trackAnswer(site, target);
  const std::string path = target.pathText();
  if (path == "/api/events") return eventsAnswer(site, target);
  if (path == "/api/state") return stateAnswer(site, target);
  serve::requireOnly(target, {});
  if (path == "/api/info") return json(infoJson(site.session, site.map, site.connections));
  if (path == "/api/tracks") return json(site.session.stage().tracksJson());
  if (path == "/api/intervals") return json(serve::intervalsJson(site.session.stage().scenery().names));
  if (path == "/api/summary") return fileOf(site, "summary.json", "application/json");
  if (path == "/api/report") return fileOf(site, "report.html", "text/html; charset=utf-8");
  if (path == "/api/map") return mapAnswer(site);
  if (path == "/api/map/background") return backgroundAnswer(site);
  throw serve::notFound("there is nothing at " + path);
}

bool hasFile(const Session& session, const char* name) {
  const fs::path* folder = session.folder();
  return folder != nullptr && fs::is_regular_file(*folder / name);
}

}  // namespace

std::string infoJson(Session& session, const serve::MapService* map,
                     const serve::ConnectionRules& connections) {
  const Scenery& scenery = session.stage().scenery();
  const auto seconds = [](const std::optional<Stamp>& stamp) {
    return stamp ? Json(secondsSinceOrigin(*stamp)) : Json(nullptr);
  };
  Json info{{"protocol", 1},
            {"pos_version", version()},
            {"mode", serve::name(scenery.mode)},
            {"name", scenery.name},
            {"map", scenery.map_name},
            {"map_editable", map != nullptr && map->editable()},
            {"first_s", seconds(session.stage().first())},
            {"last_s", seconds(session.stage().last())},
            {"truth", scenery.reference.has_value()},
            {"summary", hasFile(session, "summary.json")},
            {"report", hasFile(session, "report.html")},
            {"intervals", scenery.intervals},
            {"estimators", Json::array()},
            {"tracks", Json::array()},
            {"columns", serve::columnNames()},
            {"stale_after_s", connections.stale_after},
            {"lost_after_s", connections.lost_after}};
  if (scenery.reference || scenery.mode == serve::Mode::Live) info["tracks"].push_back(Stage::kTruth);
  for (const Scenery::Title& title : scenery.estimators) {
    info["estimators"].push_back({{"name", title.name}, {"type", title.type}});
    info["tracks"].push_back(title.name);
  }
  return info.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<Asset> backgroundOf(const fs::path& map_file) {
  const auto background = io::readMapFile(map_file).map.background;
  if (!background) return std::nullopt;
  io::BackgroundPicture picture = io::loadPicture(map_file.parent_path() / background->file);
  const bool png = picture.bytes.starts_with("\x89PNG");
  return Asset{png ? "image/png" : "image/jpeg", std::move(picture.bytes)};
}

Answer answerToGet(Site& site, const serve::Target& target) {
  if (!target.path.empty() && target.path.front() == "api") return apiAnswer(site, target);
  const auto asset = site.assets.find(target.path.empty() ? "/index.html" : target.pathText());
  if (asset == site.assets.end()) throw serve::notFound("there is no page " + target.pathText());
  return {
      .type = asset->second.type, .body = asset->second.bytes, .headers = {{"Cache-Control", "no-cache"}}};
}

Answer answerToPost(Site& site, const serve::Target& target, const std::string& body) {
  const std::string path = target.pathText();
  if (path == "/api/map/coverage") return json(mapOf(site).coverage(body, target));
  serve::requireOnly(target, {});
  if (path == "/api/command") {
    site.session.command(serve::parsedCommand(body));
    return json(site.ticker.state());
  }
  if (path == "/api/map/check") return json(mapOf(site).check(body));
  if (path == "/api/map/diff") return json(mapOf(site).diff(body));
  if (path == "/api/map/intervals") return json(mapOf(site).intervals(body));
  throw serve::notFound("nothing can be posted to " + path);
}

Answer answerToPut(Site& site, const serve::Target& target, const std::string& body,
                   const std::string& if_match) {
  serve::requireOnly(target, {});
  if (target.pathText() != "/api/map") throw serve::notFound("nothing can be put at " + target.pathText());
  const std::string version = mapOf(site).save(body, if_match);
  return {.body = Json{{"version", version}}.dump(),
          .headers = {{"Cache-Control", "no-store"}, {"ETag", version}}};
}

}  // namespace pos::app
