#pragma once
/// The drawings of a campaign, one function each. Internal to report.

#include <optional>
#include <string>

#include "figure_parts.hpp"
#include "pos/eval/campaign.hpp"
#include "pos/report/figures.hpp"

namespace pos::report {

// Each gives nothing where the campaign has no data for it.
std::optional<NamedFigure> spreadFigure(const eval::CampaignSummary& campaign, const std::string& metric);
std::optional<NamedFigure> rmseOverTimeFigure(const eval::CampaignSummary& campaign);
std::optional<NamedFigure> aneesFigure(const eval::CampaignSummary& campaign);
std::optional<NamedFigure> pairFigure(const eval::CampaignSummary& campaign);

}  // namespace pos::report
