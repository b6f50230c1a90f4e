#include "pos/eval/campaign_run.hpp"

#include "pos/core/random.hpp"
#include "pos/eval/requirement.hpp"

namespace pos::eval {
namespace {

constexpr std::uint32_t kSeedDomain =
    2;  ///< keeps these numbers apart from those of any RandomStream below 2^33

std::uint32_t low(std::uint64_t word) {
  return static_cast<std::uint32_t>(word);
}
std::uint32_t high(std::uint64_t word) {
  return static_cast<std::uint32_t>(word >> 32U);
}

}  // namespace

std::uint64_t seedOfRun(std::uint64_t campaign_seed, std::uint64_t index) {
  const auto words =
      philox4x32({low(index), high(index), 0U, kSeedDomain}, {low(campaign_seed), high(campaign_seed)});
  return ((std::uint64_t{words[0]} << 32U) | words[1]) >> 11U;
}

CampaignRun campaignRun(const RunSummary& run, std::uint64_t index, const std::string& repeat) {
  CampaignRun kept{.index = index, .seed = run.seed, .repeat = repeat, .estimators = {}};
  for (const EstimatorSummary& estimator : run.estimators) {
    CampaignEntry entry{.name = estimator.name,
                        .type = estimator.type,
                        .metrics = metrics(estimator, run.end - run.start),
                        .events = estimator.events,
                        .cells = estimator.cells};
    std::erase_if(entry.metrics, [](const auto& metric) { return metric.first.starts_with("compute."); });
    kept.estimators.push_back(std::move(entry));
  }
  return kept;
}

}  // namespace pos::eval
