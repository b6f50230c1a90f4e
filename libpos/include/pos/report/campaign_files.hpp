#pragma once
/// The files of a campaign as text; docs/formats/campaign.md describes them.

#include <string>
#include <string_view>

#include "pos/eval/campaign.hpp"

namespace pos::report {

/// One run as one line of JSON. `fingerprint` tells which campaign it belongs to. Values on the grid keep six
/// digits that count, all others are exact.
std::string campaignRunJson(const eval::CampaignRun& run, const std::string& fingerprint);

/// Reads it back. Throws DataError, naming `file`, for text that is damaged or cut short; ConfigError for a
/// run with another fingerprint.
eval::CampaignRun campaignRunFrom(std::string_view text, const std::string& file,
                                  const std::string& fingerprint);

/// campaign.json: everything but the single runs and moments.
std::string campaignJson(const eval::CampaignSummary& campaign);

/// campaign.csv: one line an estimator and metric: count, mean, std, median, min, max, worst, its run and
/// seed.
std::string campaignCsv(const eval::CampaignSummary& campaign);

/// runs.csv: one line a run and estimator, one column a metric.
std::string runsCsv(const eval::CampaignSummary& campaign);

/// moments.csv: one line a moment and estimator: runs, RMSE over the runs, ANEES with bounds, NIS.
std::string momentsCsv(const eval::CampaignSummary& campaign);

}  // namespace pos::report
