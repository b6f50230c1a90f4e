#include "campaign_results.hpp"

#include "pos/eval/campaign_requirement.hpp"
#include "pos/report/campaign_files.hpp"
#include "pos/report/campaign_table.hpp"

namespace pos::app {

namespace fs = std::filesystem;

void judge(const eval::CampaignSummary& campaign, const OutputOptions& outputs, const Voice& voice) {
  std::vector<eval::RequirementResult> results;
  for (const std::string& text : outputs.requirements) {
    for (const eval::RequirementResult& result : eval::checkOverRuns(text, campaign))
      results.push_back(result);
  }
  requireAllPassed(results, voice);
}

void tell(const Manifest& manifest, const eval::CampaignSummary& campaign, const OutputOptions& outputs,
          const Voice& voice) {
  if (!outputs.folder.empty()) writeCampaign(outputs.folder, manifest, campaign);
  for (const std::string& warning : report::campaignWarnings(campaign)) voice.say("note: " + warning);
  print(outputs.json ? report::campaignJson(campaign) : report::campaignText(campaign));
  if (!outputs.folder.empty()) voice.say("report: " + (fs::path(outputs.folder) / "campaign.html").string());
}

std::string countText(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " run" : " runs");
}

}  // namespace pos::app
