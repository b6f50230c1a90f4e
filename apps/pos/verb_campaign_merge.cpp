/// `pos campaign merge`: the runs of several folders of one campaign taken together.

#include <algorithm>
#include <memory>

#include "campaign.hpp"
#include "campaign_results.hpp"
#include "pos/core/error.hpp"

namespace pos::app {
namespace {

struct MergeOptions {
  std::vector<std::string> folders;
  OutputOptions outputs;
  bool partial = false;
};

/// The campaign that all folders are parts of.
Manifest commonManifest(const std::vector<std::string>& folders) {
  Manifest first = Manifest::read(folders.front());
  for (const std::string& folder : folders) {
    const Manifest other = Manifest::read(folder);
    const bool same = other.fingerprint() == first.fingerprint();
    if (same && other.head.runs == first.head.runs) continue;
    throw ConfigError(
        Complaint{.what = "the folders are not parts of one campaign",
                  .place = {.file = folder},
                  .got = same ? std::to_string(other.head.runs) + " runs, in " + folders.front() + " " +
                                    std::to_string(first.head.runs)
                              : "it differs from " + folders.front() + " in " + difference(first, other),
                  .suggestion = "merge folders made by the same command, with different --shard"});
  }
  return first;
}

std::string runList(const std::vector<std::uint64_t>& runs) {
  std::string list;
  for (std::size_t i = 0; i < std::min<std::size_t>(runs.size(), 10); ++i)
    list += (i > 0 ? ", " : "") + std::to_string(runs[i]);
  return list + (runs.size() > 10 ? ", ..." : "");
}

using Parts = std::vector<std::unique_ptr<RunRecords>>;

/// The part that holds a run, the first of several; null where none does.
const RunRecords* holderOf(const Parts& parts, std::uint64_t run) {
  const auto part = std::find_if(parts.begin(), parts.end(), [run](const auto& p) { return p->has(run); });
  return part == parts.end() ? nullptr : part->get();
}

void requireAllRuns(const Manifest& manifest, const Parts& parts, const std::string& place) {
  std::vector<std::uint64_t> missing;
  for (std::uint64_t run = 0; run < manifest.head.runs; ++run) {
    if (holderOf(parts, run) == nullptr) missing.push_back(run);
  }
  if (missing.empty()) return;
  throw DataError(Complaint{
      .what = std::to_string(missing.size()) + " of " + countText(manifest.head.runs) + " are missing",
      .place = {.file = place},
      .got = "no record of run " + runList(missing),
      .suggestion = "give the command of that part again, it does the missing runs only; or merge what there "
                    "is with --partial"});
}

void gather(const Manifest& manifest, const Parts& parts, RunRecords& into) {
  for (std::uint64_t run = 0; run < manifest.head.runs; ++run) {
    const RunRecords* part = into.has(run) ? nullptr : holderOf(parts, run);
    if (part != nullptr) into.put(run, part->text(run));
  }
}

ExitCode runMerge(const MergeOptions& options, const Voice& voice) {
  const Manifest manifest = commonManifest(options.folders);
  Parts parts;
  for (const std::string& part : options.folders) parts.push_back(std::make_unique<RunRecords>(part));
  if (!options.partial) requireAllRuns(manifest, parts, options.folders.front());
  const std::string& folder = options.outputs.folder;
  if (!folder.empty()) {
    openCampaignFolder(folder, manifest, options.outputs.force ? EarlierRuns::Drop : EarlierRuns::Continue);
  }
  const std::unique_ptr<RunRecords> records =
      folder.empty() ? std::make_unique<RunRecords>() : std::make_unique<RunRecords>(folder);
  gather(manifest, parts, *records);
  const eval::CampaignSummary campaign = summaryOfRuns(manifest, *records);
  tell(manifest, campaign, options.outputs, voice);
  judge(campaign, options.outputs, voice);
  return ExitCode::Ok;
}

}  // namespace

void addCampaignMerge(CLI::App& campaign, const Verbs& verbs) {
  CLI::App* verb =
      campaign.add_subcommand("merge", "Take the runs of several folders of one campaign together");
  auto options = std::make_shared<MergeOptions>();
  verb->add_option("folders", options->folders, "Folders that `pos campaign --shard --out` wrote")
      ->required();
  addOutputs(*verb, options->outputs);
  verb->add_flag("--partial", options->partial, "Also when runs are missing");
  addVoice(*verb, *verbs.voice);
  verb->callback([options, verbs] { *verbs.code = runMerge(*options, *verbs.voice); });
}

}  // namespace pos::app
