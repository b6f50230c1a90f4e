#include "pos/interval/lock_rules.hpp"

#include <cmath>
#include <string>

#include "pos/core/error.hpp"

namespace pos::interval {
namespace {

void positive(double value, const char* key) {
  if (std::isfinite(value) && value > 0.0) return;
  throw ConfigError(Complaint{.what = "a lock rule needs a number above zero",
                              .key = key,
                              .got = std::to_string(value),
                              .expected = "> 0"});
}

void notNegative(double value, const char* key) {
  if (std::isfinite(value) && value >= 0.0) return;
  throw ConfigError(Complaint{.what = "a lock rule must not be negative",
                              .key = key,
                              .got = std::to_string(value),
                              .expected = ">= 0"});
}

}  // namespace

LockRules validated(LockRules rules) {
  positive(rules.footprint_sigmas, "footprint_sigmas");
  notNegative(rules.release_sigmas, "release_sigmas");
  notNegative(rules.release_margin, "release_margin_m");
  positive(rules.stale_after, "stale_after_s");
  positive(rules.steady_for, "steady_for_s");
  positive(rules.jump_sigmas, "jump_sigmas");
  notNegative(rules.speed_error, "speed_error_m_per_s");
  positive(rules.jump_slack, "jump_slack_m");
  notNegative(rules.gap_between, "gap_between_m");
  notNegative(rules.patience, "patience_s");
  positive(rules.aging, "aging_s");
  return rules;
}

}  // namespace pos::interval
