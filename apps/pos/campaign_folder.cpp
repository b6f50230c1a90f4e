#include "campaign_folder.hpp"

#include <unistd.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common.hpp"
#include "pos/core/error.hpp"
#include "pos/io/sha256.hpp"
#include "pos/report/campaign_files.hpp"
#include "pos/report/campaign_html.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "pos.campaign.manifest/1";
constexpr std::array kResults{"campaign.json", "campaign.csv", "runs.csv", "moments.csv", "campaign.html"};

std::string fileText(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// Unlike that of any other process, also on other machines that share the disk.
std::string draftEnding() {
  std::array<char, 256> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  return std::string(".part-") + host.data() + "-" + std::to_string(::getpid());
}

/// Written beside the file and moved into place.
void writeWhole(const fs::path& path, const std::string& text) {
  const fs::path draft = path.string() + draftEnding();
  writeFile(draft, text);
  std::error_code failed;
  fs::rename(draft, path, failed);
  if (!failed) return;
  throw DataError(Complaint{
      .what = "the file cannot be written", .place = {.file = path.string()}, .got = failed.message()});
}

std::string runFileName(std::uint64_t run) {
  const std::string digits = std::to_string(run);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits + ".json";
}

[[noreturn]] void refuseFolder(const fs::path& folder, const std::string& what, const std::string& got,
                               const std::string& suggestion) {
  throw ConfigError(
      Complaint{.what = what, .place = {.file = folder.string()}, .got = got, .suggestion = suggestion});
}

/// Only what a campaign writes: a wrong --out must not cost anybody a file.
void dropEarlier(const fs::path& folder) {
  for (const char* name : kResults) fs::remove(folder / name);
  fs::remove(folder / "manifest.json");
  if (!fs::is_directory(folder / "runs")) return;
  for (const auto& entry : fs::directory_iterator(folder / "runs")) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name.find(".json") != std::string::npos) fs::remove(entry.path());
  }
  if (fs::is_empty(folder / "runs")) fs::remove(folder / "runs");
}

/// Something in the folder that no campaign writes; another part may just be making the folder.
std::optional<std::string> stranger(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != "runs" && name.find(".part-") == std::string::npos) return name;
  }
  return std::nullopt;
}

void requireSameCampaign(const fs::path& folder, const Manifest& manifest, EarlierRuns earlier) {
  if (!fs::exists(folder / "manifest.json")) {
    const auto name = stranger(folder);
    if (name && !fs::exists(folder / "manifest.json"))  // it may have come meanwhile
      refuseFolder(folder, "the folder is not empty and holds no campaign", *name, "name another folder");
    return;
  }
  const Manifest there = Manifest::read(folder);
  if (there.fingerprint() == manifest.fingerprint()) return;
  if (earlier == EarlierRuns::Drop) return dropEarlier(folder);
  refuseFolder(folder, "the folder holds another campaign", "it differs in " + difference(there, manifest),
               "name another folder, or give --force to drop the runs in it");
}

Json inputJson(const Manifest::Input& input) {
  return {{"role", input.role}, {"file", input.file}, {"sha256", input.sha256}};
}

Manifest manifestFrom(const Json& json) {
  Manifest m;
  m.head.name = json.at("name").get<std::string>();
  m.head.input = json.at("input").get<std::string>();
  m.head.recorded = json.at("recorded").get<bool>();
  m.head.map = json.at("map").get<std::string>();
  m.head.seed = json.at("seed").get<std::uint64_t>();
  m.head.runs = json.at("runs").get<std::uint64_t>();
  m.head.step = json.at("step_s").get<double>();
  m.head.baseline = json.at("baseline").get<std::string>();
  m.version = json.at("pos_version").get<std::string>();
  m.git = json.at("git").get<std::string>();
  for (const Json& input : json.at("inputs")) {
    m.inputs.push_back({input.at("role").get<std::string>(), input.at("file").get<std::string>(),
                        input.at("sha256").get<std::string>()});
  }
  m.config = json.at("config").get<std::string>();
  m.settings = json.at("settings_sha256").get<std::string>();
  m.command = json.at("command").get<std::string>();
  return m;
}

}  // namespace

std::string Manifest::fingerprint() const {
  std::string all = version + "\n" + git + "\n" + std::to_string(head.seed) + "\n" + settings + "\n";
  for (const Input& input : inputs) all += input.role + " " + input.sha256 + "\n";
  return io::sha256(all);
}

std::string Manifest::json() const {
  Json list = Json::array();
  for (const Input& input : inputs) list.push_back(inputJson(input));
  const Json json = {{"format", kFormat},           {"fingerprint", fingerprint()},
                     {"name", head.name},           {"input", head.input},
                     {"recorded", head.recorded},   {"map", head.map},
                     {"seed", head.seed},           {"runs", head.runs},
                     {"step_s", head.step},         {"baseline", head.baseline},
                     {"pos_version", version},      {"git", git},
                     {"command", command},          {"inputs", std::move(list)},
                     {"settings_sha256", settings}, {"config", config}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Manifest Manifest::read(const fs::path& folder) {
  const fs::path path = folder / "manifest.json";
  if (!fs::exists(path)) {
    throw DataError(Complaint{.what = "this is no folder of a campaign: it has no manifest.json",
                              .place = {.file = folder.string()},
                              .suggestion = "give the folder that `pos campaign --out` wrote"});
  }
  try {
    const Json json = Json::parse(fileText(path));
    if (json.at("format") != kFormat) throw DataError("unknown format");
    Manifest manifest = manifestFrom(json);
    if (json.at("fingerprint") != manifest.fingerprint()) throw DataError("it was changed by hand");
    return manifest;
  } catch (const std::exception& error) {
    throw DataError(Complaint{
        .what = "manifest.json cannot be used", .place = {.file = path.string()}, .got = error.what()});
  }
}

std::string difference(const Manifest& there, const Manifest& here) {
  if (there.version != here.version || there.git != here.git) {
    return "the build of pos (" + there.version + " " + there.git + ", here " + here.version + " " +
           here.git + ")";
  }
  if (there.head.seed != here.head.seed)
    return "the seed (" + std::to_string(there.head.seed) + ", here " + std::to_string(here.head.seed) + ")";
  if (there.settings != here.settings)
    return "the configuration (" + there.head.name + ", here " + here.head.name + ")";
  for (std::size_t i = 0; i < std::min(there.inputs.size(), here.inputs.size()); ++i) {
    if (there.inputs[i].sha256 != here.inputs[i].sha256)
      return "the content of the " + here.inputs[i].role + " (" + here.inputs[i].file + ")";
  }
  return "its inputs";
}

fs::path RunRecords::file(std::uint64_t run) const {
  return *folder_ / runFileName(run);
}

std::string RunRecords::place(std::uint64_t run) const {
  return folder_ ? file(run).string() : "run " + std::to_string(run);
}

bool RunRecords::has(std::uint64_t run) const {
  if (!folder_) {
    const std::scoped_lock lock(mutex_);
    return texts_.contains(run);
  }
  std::ifstream text(file(run), std::ios::binary | std::ios::ate);
  if (!text || text.tellg() < 2) return false;
  text.seekg(-2, std::ios::end);
  return text.get() == '}' && text.get() == '\n';
}

void RunRecords::put(std::uint64_t run, const std::string& text) {
  if (folder_) return writeWhole(file(run), text);
  const std::scoped_lock lock(mutex_);
  texts_[run] = text;
}

std::string RunRecords::text(std::uint64_t run) const {
  if (folder_) return fileText(file(run));
  const std::scoped_lock lock(mutex_);
  return texts_.at(run);
}

void openCampaignFolder(const fs::path& folder, const Manifest& manifest, EarlierRuns earlier) {
  try {
    if (fs::exists(folder) && !fs::is_directory(folder))
      refuseFolder(folder, "the folder of the campaign is a file", "a file", "name another folder");
    fs::create_directories(folder);
    requireSameCampaign(folder, manifest, earlier);
    fs::create_directories(folder / "runs");
  } catch (const fs::filesystem_error& error) {
    refuseFolder(folder, "cannot make the folder of the campaign", error.code().message(),
                 "check the path and its rights");
  }
  writeWhole(folder / "manifest.json", manifest.json());
}

void writeCampaign(const fs::path& folder, const Manifest& manifest, const eval::CampaignSummary& campaign) {
  writeWhole(folder / "campaign.json", report::campaignJson(campaign));
  writeWhole(folder / "campaign.csv", report::campaignCsv(campaign));
  writeWhole(folder / "runs.csv", report::runsCsv(campaign));
  writeWhole(folder / "moments.csv", report::momentsCsv(campaign));
  writeWhole(folder / "campaign.html", report::campaignHtml(campaign, manifest.config));
}

}  // namespace pos::app
