#pragma once
/// Where a campaign keeps what it is and the record of every run that is done.

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "pos/eval/campaign.hpp"

namespace pos::app {

/// manifest.json: what the runs are of. Folders with the same fingerprint hold runs of one campaign.
struct Manifest {
  struct Input {
    std::string role;  ///< "log", "scenario", "map", "truth"
    std::string file;  ///< absolute
    std::string sha256;

    bool operator==(const Input&) const = default;
  };
  eval::CampaignHead head;
  std::string version;
  std::string git;
  std::vector<Input> inputs;
  std::string config;    ///< resolved, YAML
  std::string settings;  ///< sha256 of all settings that a run's figures depend on, paths left out
  std::string command;   ///< how to run it, without --out and --jobs

  /// sha256 over version, seed, settings and the checksums of the inputs.
  std::string fingerprint() const;
  std::string json() const;
  /// Throws DataError when the folder holds none or a damaged one.
  static Manifest read(const std::filesystem::path& folder);
};

/// The first thing in which two campaigns differ, for people: "the seed (1, here 2)".
std::string difference(const Manifest& there, const Manifest& here);

/// Records of runs, one text a run: on disk, or in memory for a campaign without a folder. All members may be
/// called from several threads.
class RunRecords {
 public:
  /// In memory.
  RunRecords() = default;
  /// In `folder`/runs.
  explicit RunRecords(const std::filesystem::path& folder) : folder_(folder / "runs") {}

  /// A record is there and was written to its end.
  bool has(std::uint64_t run) const;
  /// Appears whole or not at all, also when the process is killed meanwhile.
  void put(std::uint64_t run, const std::string& text);
  std::string text(std::uint64_t run) const;
  /// For messages.
  std::string place(std::uint64_t run) const;

 private:
  std::filesystem::path file(std::uint64_t run) const;

  std::optional<std::filesystem::path> folder_;
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::string> texts_;
};

/// What to do with a folder that holds another campaign. Runs of the same one are always kept.
enum class EarlierRuns {
  Continue,  ///< ConfigError
  Drop,      ///< remove its files
};

/// Makes or takes over the folder and writes its manifest. Parts of one campaign may do so at the same time.
/// Throws ConfigError also for a folder that holds anything but a campaign.
void openCampaignFolder(const std::filesystem::path& folder, const Manifest& manifest, EarlierRuns earlier);

/// campaign.json, campaign.csv, runs.csv, moments.csv, campaign.html.
void writeCampaign(const std::filesystem::path& folder, const Manifest& manifest,
                   const eval::CampaignSummary& campaign);

}  // namespace pos::app
