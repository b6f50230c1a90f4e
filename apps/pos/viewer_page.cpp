#include "viewer_page.hpp"

#include <nlohmann/json.hpp>

#include "interface_files.hpp"
#include "pos/core/error.hpp"
#include "pos/io/files.hpp"
#include "pos/report/png.hpp"
#include "serve_http.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kPoints = 6000;     // of a track, 0.4 MB
constexpr std::size_t kMostRows = 16384;  // of a table, in memory, of which those points are taken
constexpr std::size_t kMostEvents = 10'000;
constexpr std::string_view kMark = "POS_RUN_JSON";

/// What the page draws; a truth has no errors and no sigmas.
std::vector<serve::Column> columnsOf(bool truth) {
  using serve::Column;
  std::vector<Column> columns{Column::X,     Column::Y,       Column::Z,        Column::Yaw,
                              Column::Speed, Column::Roadway, Column::Chainage, Column::Interval};
  if (!truth) {
    for (const Column column : {Column::SigmaX, Column::SigmaY, Column::CorrXY, Column::Error})
      columns.push_back(column);
  }
  return columns;
}

Json trackJson(const Stage& stage, const std::string& name) {
  const std::vector<serve::Column> columns = columnsOf(name == Stage::kTruth);
  Json names = Json::array();
  for (const serve::Column column : columns)
    names.push_back(serve::columnNames()[static_cast<std::size_t>(column)]);
  return {{"name", name},
          {"columns", std::move(names)},
          {"base64", report::base64(stage.packed(name, {.points = kPoints, .columns = columns}))}};
}

Json pictureJson(const fs::path& map_file) {
  const std::optional<Asset> picture = backgroundOf(map_file);
  return picture ? Json("data:" + picture->type + ";base64," + report::base64(picture->bytes))
                 : Json(nullptr);
}

/// What `/api/` would answer, in one object.
std::string runJson(Session& session) {
  std::optional<serve::MapService> map;
  if (const auto file = session.mapFile()) map.emplace(*file, serve::MapService::Access::ReadOnly);
  Stage& stage = session.stage();
  Json run{{"format", "pos.viewer/1"}, {"info", Json::parse(infoJson(session, nullptr, {}))}};
  run["map"] = map ? Json::parse(map->saved().geojson) : Json(nullptr);
  run["intervals"] = Json::parse(serve::intervalsJson(stage.scenery().names)).at("intervals");
  run["events"] = Json::parse(stage.eventsJson(0, kMostEvents)).at("events");
  run["tracks"] = Json::array();
  for (const Json& name : run.at("info").at("tracks"))
    run["tracks"].push_back(trackJson(stage, name.get<std::string>()));
  run["locks"] = Json::parse(stage.lockChangesJson());
  run["background"] = map ? pictureJson(map->file()) : Json(nullptr);
  return run.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Text that no HTML reader takes for an element.
std::string withoutElements(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) c == '<' ? text += "\\u003c" : text += c;
  return text;
}

}  // namespace

std::optional<std::string> viewerTemplate(const std::string& named) {
  const auto folder = interfaceFolder(named);
  if (!folder) return std::nullopt;
  const fs::path file = *folder / kViewerFile;
  if (named.empty() && !fs::exists(file)) return std::nullopt;
  std::string page = io::fileText(io::existingFile(file, Complaint{.key = "--interface"}));
  if (page.find(kMark) != std::string::npos) return page;
  throw DataError(Complaint{.what = "this page has no place for a run",
                            .place = {.file = file.string()},
                            .expected = "the text " + std::string(kMark) + " in it",
                            .suggestion = "build the interface again: scripts/hmi"});
}

void writeViewer(const fs::path& folder, const Inputs& inputs, const std::string& page) {
  const auto session = runSession(folder.string(), inputs, kMostRows);
  std::string filled = page;
  filled.replace(filled.find(kMark), kMark.size(), withoutElements(runJson(*session)));
  writeFile(folder / kViewerFile, filled);
}

}  // namespace pos::app
