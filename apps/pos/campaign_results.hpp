#pragma once
/// What a campaign says when its runs are there, for `pos campaign` and `pos campaign merge`.

#include <string>

#include "campaign_folder.hpp"
#include "outputs.hpp"

namespace pos::app {

/// "1 run", "200 runs".
std::string countText(std::size_t count);

/// Files in the folder of --out, then the table or JSON.
void tell(const Manifest& manifest, const eval::CampaignSummary& campaign, const OutputOptions& outputs,
          const Voice& voice);

/// Throws RequirementMissed when a --require was missed.
void judge(const eval::CampaignSummary& campaign, const OutputOptions& outputs, const Voice& voice);

/// `merge` below `pos campaign`.
void addCampaignMerge(CLI::App& campaign, const Verbs& verbs);

}  // namespace pos::app
