#pragma once
/// `pos campaign --require 'worst:p95_xy<1.0'`: a limit that all runs together must keep.

#include <string>
#include <vector>

#include "pos/eval/campaign.hpp"
#include "pos/eval/requirement.hpp"

namespace pos::eval {

/// Checks `[mean:|std:|median:|min:|max:|worst:][estimator.]metric(<|<=|>|>=)number`, without the first part
/// the mean over the runs. Metrics are those of a single run and mean_rmse_xy, max_rmse_xy, anees_xy,
/// anees_xy_inside, anees_pose, anees_pose_inside. Throws UsageError as parseRequirement() does.
std::vector<RequirementResult> checkOverRuns(const std::string& text, const CampaignSummary& campaign);

/// Throws the same UsageError before there are runs: for a text that no campaign of these estimators could
/// answer. Figures of a sensor are left for later: only the input tells its sensors.
void refuseUnknownOverRuns(const std::string& text, const std::vector<std::string>& estimators);

}  // namespace pos::eval
