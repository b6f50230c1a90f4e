#pragma once
/// The folder that holds one run: what was asked, what came out.

#include <filesystem>
#include <string>

#include "pos/core/stamp.hpp"
#include "pos/io/trajectory_io.hpp"

namespace pos::io {

/// What to do with a folder that already holds files.
enum class ExistingRun {
  Refuse,   ///< ConfigError
  Replace,  ///< remove the files of the earlier run (those named below, nothing else)
};

class RunFolder {
 public:
  /// Makes the folder, with its parents. Throws ConfigError when it cannot, or when it is not empty and
  /// `existing` says Refuse.
  static RunFolder create(const std::filesystem::path& folder, ExistingRun existing);

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path runJson() const { return folder_ / "run.json"; }
  std::filesystem::path eventsCsv() const { return folder_ / "events.csv"; }
  std::filesystem::path summaryJson() const { return folder_ / "summary.json"; }
  std::filesystem::path reportHtml() const { return folder_ / "report.html"; }
  /// What a simulation leaves: the log, the truth, the map with its grid.
  std::filesystem::path log() const { return folder_ / "log.rawlog"; }
  std::filesystem::path truth() const { return folder_ / "truth.tum"; }
  std::filesystem::path map() const { return folder_ / "map.yaml"; }
  std::filesystem::path grid() const { return folder_ / "grid.gridmap.gz"; }
  /// <estimator>.tum and <estimator>.csv. Throws ConfigError for a name that makes no good file name
  /// (letters, digits, '_', '-', '.'; not "events").
  std::filesystem::path tum(const std::string& estimator) const;
  std::filesystem::path csv(const std::string& estimator) const;
  /// <estimator>.intervals.csv.
  std::filesystem::path intervalsCsv(const std::string& estimator) const;

 private:
  explicit RunFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::filesystem::path folder_;
};

/// Something worth a line in events.csv: a lost link, a change of mode, a rejected sensor.
struct RunEvent {
  Stamp stamp;
  std::string estimator;
  std::string kind;
  std::string sensor = {};
  std::string detail = {};
};

/// Columns stamp_s,estimator,kind,sensor,detail.
class EventsCsvWriter {
 public:
  explicit EventsCsvWriter(const std::filesystem::path& path);
  void write(const RunEvent& event);
  void flush() { lines_.flush(); }
  void close() { lines_.close(); }

 private:
  LineWriter lines_;
};

}  // namespace pos::io
