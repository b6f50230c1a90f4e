#pragma once
/// campaign.html: one file that needs no network.

#include <string>
#include <vector>

#include "pos/eval/campaign.hpp"
#include "pos/report/figures.hpp"

namespace pos::report {

/// Every figure that the campaign has data for, in the order of the page. The same runs give the same bytes.
std::vector<NamedFigure> campaignFigures(const eval::CampaignSummary& campaign);

/// The page of a campaign. `resolved_config` is shown as it is at the end.
std::string campaignHtml(const eval::CampaignSummary& campaign, const std::string& resolved_config);

}  // namespace pos::report
