#include "pos/io/run_folder.hpp"

#include <array>
#include <vector>

#include "pos/core/error.hpp"
#include "pos/io/text.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

/// Of a replay and of a simulation.
constexpr std::array kRunFiles{"run.json",   "events.csv",       "summary.json",    "report.html",
                               "log.rawlog", "map.yaml",         "grid.gridmap.gz", "audit.csv",
                               "scene.json", "time_distance.svg"};

[[noreturn]] void refuseFolder(const fs::path& folder, const std::string& what, const std::string& got,
                               const std::string& suggestion) {
  throw ConfigError(Complaint{.what = what,
                              .place = {.file = folder.string()},
                              .got = got,
                              .expected = "a folder that is empty or does not exist yet",
                              .suggestion = suggestion});
}

/// The files an earlier run left in the folder: the fixed names, and each x.tum with its tables.
std::vector<fs::path> earlierRun(const fs::path& folder) {
  std::vector<fs::path> files;
  files.reserve(kRunFiles.size());
  for (const char* name : kRunFiles) files.push_back(folder / name);
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".tum" || !entry.is_regular_file()) continue;
    files.push_back(entry.path());
    files.push_back(fs::path(entry.path()).replace_extension(".csv"));
    for (const char* table : {".intervals.csv", ".face_track.csv", ".face_bend.csv", ".face_creep.csv"})
      files.push_back(fs::path(entry.path()).replace_extension(table));
  }
  return files;
}

void requireFileName(const std::string& estimator) {
  const std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  const bool good = !estimator.empty() && estimator.size() <= 100 && estimator[0] != '.' &&
                    estimator.find_first_not_of(allowed) == std::string::npos && estimator != "events";
  if (good) return;
  throw ConfigError(
      Complaint{.what = "the estimator's name makes no good file name",
                .key = "estimators.name",
                .got = "'" + estimator + "'",
                .expected = "letters, digits, '_', '-', '.'; not starting with '.', not 'events'"});
}

}  // namespace

RunFolder RunFolder::create(const fs::path& folder, ExistingRun existing) {
  try {
    if (fs::exists(folder) && !fs::is_directory(folder)) {
      refuseFolder(folder, "the run folder is a file", "a file", "name another folder");
    }
    fs::create_directories(folder);
    if (!fs::is_empty(folder) && existing == ExistingRun::Refuse) {
      refuseFolder(folder, "the run folder is not empty", fs::directory_iterator(folder)->path().filename(),
                   "name another folder, or give --force to replace the run in it");
    }
    for (const fs::path& file : earlierRun(folder)) fs::remove(file);
  } catch (const fs::filesystem_error& error) {
    refuseFolder(folder, "cannot make the run folder", error.code().message(),
                 "check the path and its rights");
  }
  return RunFolder(folder);
}

fs::path RunFolder::tum(const std::string& estimator) const {
  requireFileName(estimator);
  return folder_ / (estimator + ".tum");
}

fs::path RunFolder::intervalsCsv(const std::string& estimator) const {
  requireFileName(estimator);
  return folder_ / (estimator + ".intervals.csv");
}

fs::path RunFolder::csv(const std::string& estimator) const {
  requireFileName(estimator);
  return folder_ / (estimator + ".csv");
}

EventsCsvWriter::EventsCsvWriter(const fs::path& path) : lines_(path) {
  lines_.write("stamp_s,estimator,kind,sensor,detail");
}

void EventsCsvWriter::write(const RunEvent& event) {
  std::string row = text::stampSeconds(event.stamp);
  for (const std::string* cell : {&event.estimator, &event.kind, &event.sensor, &event.detail}) {
    row += ',' + text::csvCell(*cell);
  }
  lines_.write(row);
}

}  // namespace pos::io
