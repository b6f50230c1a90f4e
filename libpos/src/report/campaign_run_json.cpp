#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "pos/core/error.hpp"
#include "pos/report/campaign_files.hpp"

namespace pos::report {
namespace {

using Json = nlohmann::ordered_json;
using eval::GridCell;

constexpr const char* kFormat = "pos.campaign.run/1";

struct Column {
  const char* name;
  double GridCell::*field;
  double nothing;
};
constexpr std::array kColumns{Column{"squared_xy_m2", &GridCell::squared_xy, GridCell::kNothing},
                              Column{"nees_xy", &GridCell::nees_xy, GridCell::kNothing},
                              Column{"nees_pose", &GridCell::nees_pose, GridCell::kNothing},
                              Column{"nis", &GridCell::nis, 0.0}, Column{"nis_dof", &GridCell::nis_dof, 0.0}};

double sixDigits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return std::strtod(text.data(), nullptr);
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// Values of one column, an empty list where no moment has any.
Json columnJson(const std::vector<GridCell>& cells, const Column& column) {
  Json values = Json::array();
  bool any = false;
  for (const GridCell& cell : cells) {
    const double value = cell.*column.field;
    any = any || (std::isfinite(value) && value != column.nothing);
    values.push_back(number(sixDigits(value)));
  }
  return any ? values : Json::array();
}

Json entryJson(const eval::CampaignEntry& entry) {
  Json metrics = Json::object();
  for (const auto& [name, value] : entry.metrics) metrics[name] = value ? number(*value) : Json(nullptr);
  Json grid = Json::object();
  grid["moments"] = entry.cells.size();
  for (const Column& column : kColumns) grid[column.name] = columnJson(entry.cells, column);
  return {{"name", entry.name},
          {"type", entry.type},
          {"metrics", std::move(metrics)},
          {"events", entry.events},
          {"grid", std::move(grid)}};
}

std::vector<GridCell> cellsFrom(const Json& grid) {
  std::vector<GridCell> cells(grid.at("moments").get<std::size_t>());
  for (const Column& column : kColumns) {
    const Json& values = grid.at(column.name);
    if (values.empty()) continue;
    if (values.size() != cells.size()) throw DataError("its columns differ in length");
    for (std::size_t k = 0; k < cells.size(); ++k)
      cells[k].*column.field = values[k].is_null() ? column.nothing : values[k].get<double>();
  }
  return cells;
}

eval::CampaignEntry entryFrom(const Json& json) {
  eval::CampaignEntry entry;
  entry.name = json.at("name").get<std::string>();
  entry.type = json.at("type").get<std::string>();
  for (const auto& [name, value] : json.at("metrics").items()) {
    entry.metrics[name] = value.is_null() ? std::nullopt : std::optional(value.get<double>());
  }
  entry.events = json.at("events").get<std::map<std::string, std::uint64_t>>();
  entry.cells = cellsFrom(json.at("grid"));
  return entry;
}

eval::CampaignRun runFrom(const Json& json) {
  eval::CampaignRun run;
  run.index = json.at("run").get<std::uint64_t>();
  run.seed = json.at("seed").get<std::uint64_t>();
  run.repeat = json.at("repeat").get<std::string>();
  for (const Json& entry : json.at("estimators")) run.estimators.push_back(entryFrom(entry));
  return run;
}

[[noreturn]] void refuseDamaged(const std::string& file, const std::string& got) {
  throw DataError(Complaint{.what = "the record of a run is damaged",
                            .place = {.file = file},
                            .got = got,
                            .suggestion = "delete the file and give the command of the campaign again: only "
                                          "missing runs are done"});
}

}  // namespace

std::string campaignRunJson(const eval::CampaignRun& run, const std::string& fingerprint) {
  Json estimators = Json::array();
  for (const eval::CampaignEntry& entry : run.estimators) estimators.push_back(entryJson(entry));
  const Json json = {{"format", kFormat},    {"fingerprint", fingerprint},
                     {"run", run.index},     {"seed", run.seed},
                     {"repeat", run.repeat}, {"estimators", std::move(estimators)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

eval::CampaignRun campaignRunFrom(std::string_view text, const std::string& file,
                                  const std::string& fingerprint) {
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != kFormat) refuseDamaged(file, "a format other than " + std::string(kFormat));
    if (json.at("fingerprint") == fingerprint) return runFrom(json);
  } catch (const nlohmann::json::exception& error) {
    refuseDamaged(file, error.what());
  } catch (const DataError& error) {
    if (!error.complaint().place.file.empty()) throw;
    refuseDamaged(file, error.what());
  }
  throw ConfigError(Complaint{.what = "the record of a run belongs to another campaign",
                              .place = {.file = file},
                              .suggestion = "keep the folders of different campaigns apart"});
}

}  // namespace pos::report
