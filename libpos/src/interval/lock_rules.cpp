#include "pos/interval/lock_rules.hpp"

#include "pos/core/config_checks.hpp"

namespace pos::interval {
LockRules validated(LockRules rules) {
  requirePositive(rules.footprint_sigmas, "footprint_sigmas");
  requireNotNegative(rules.release_sigmas, "release_sigmas");
  requireNotNegative(rules.release_margin, "release_margin_m");
  requirePositive(rules.stale_after, "stale_after_s");
  requirePositive(rules.steady_for, "steady_for_s");
  requirePositive(rules.jump_sigmas, "jump_sigmas");
  requireNotNegative(rules.speed_error, "speed_error_m_per_s");
  requirePositive(rules.jump_slack, "jump_slack_m");
  requireNotNegative(rules.gap_between, "gap_between_m");
  requireNotNegative(rules.patience, "patience_s");
  requirePositive(rules.aging, "aging_s");
  return rules;
}

}  // namespace pos::interval
