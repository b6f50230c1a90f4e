#pragma once
/// A campaign for the terminal, and what its page says in words.

#include <string>
#include <vector>

#include "pos/eval/campaign.hpp"
#include "pos/report/comparison.hpp"

namespace pos::report {

/// One row an estimator: means over the runs with their spread, worst run, figures over runs and moments,
/// honesty, and how the estimator does against the baseline.
Comparison campaignComparison(const eval::CampaignSummary& campaign);

/// The comparison as aligned text.
std::string campaignText(const eval::CampaignSummary& campaign);

/// What a reader must know before trusting the figures: missing runs, few runs, runs that do not differ,
/// values missing in some runs, ANEES outside its bounds.
std::vector<std::string> campaignWarnings(const eval::CampaignSummary& campaign);

/// "errors.xy.rmse" as people say it: "xy rmse (m)".
std::string metricTitle(const std::string& metric);

}  // namespace pos::report
