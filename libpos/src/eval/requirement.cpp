#include "pos/eval/requirement.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "compact_number.hpp"
#include "pos/core/edit_distance.hpp"
#include "pos/core/error.hpp"

namespace pos::eval {

namespace {

std::string nearest(std::string_view wanted, const std::vector<std::string>& candidates) {
  const auto best = std::min_element(
      candidates.begin(), candidates.end(),
      [wanted](const auto& a, const auto& b) { return editDistance(wanted, a) < editDistance(wanted, b); });
  return best == candidates.end() ? "" : *best;
}

/// Short forms of a full metric name, most readable first.
std::vector<std::string> shortForms(const std::string& full) {
  const std::size_t dot = full.find('.');
  if (dot == std::string::npos) return {};
  const std::string rest = full.substr(dot + 1);
  const std::size_t second = rest.find('.');
  if (full.starts_with("errors.")) return {rest.substr(second + 1) + "_" + rest.substr(0, second), rest};
  if (full.starts_with("fraction_under.")) return {"under_" + rest};
  if (full.starts_with("verdicts.total.")) return {rest.substr(second + 1)};
  if (full.starts_with("verdicts.")) return {};
  return {rest};
}

/// Every accepted spelling with the full name it stands for.
std::map<std::string, std::string> spellings(const std::vector<NamedMetrics>& estimators) {
  std::map<std::string, std::string> all;
  for (const NamedMetrics& estimator : estimators) {
    for (const auto& [full, value] : estimator.values) {
      all[full] = full;
      for (const std::string& form : shortForms(full)) all.emplace(form, full);
    }
  }
  return all;
}

std::vector<NamedMetrics> namedMetrics(const RunSummary& run) {
  std::vector<NamedMetrics> all;
  for (const EstimatorSummary& estimator : run.estimators) {
    all.push_back({estimator.name, metrics(estimator, run.end - run.start)});
  }
  return all;
}

[[noreturn]] void throwUsage(const std::string& text, const std::string& what, const std::string& got,
                             const std::string& suggestion) {
  throw UsageError(Complaint{
      .what = what + " in the requirement '" + text + "'",
      .key = "--require",
      .got = got,
      .expected = "[estimator.]metric(<|<=|>|>=)number, as in p95_xy<1.0 or ekf.errors.xy.rmse<=0.15",
      .suggestion = suggestion});
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

double parsedLimit(const std::string& text, const std::string& number) {
  double limit = 0.0;
  const char* end = number.data() + number.size();
  const auto [stopped, error] = std::from_chars(number.data(), end, limit);
  if (error != std::errc{} || stopped != end || !std::isfinite(limit)) {
    throwUsage(text, "the limit is not a number", number, "");
  }
  return limit;
}

/// The estimator that `left` begins with ("name."), the longest where several do; empty for none.
std::string leadingEstimator(const std::string& left, const std::vector<NamedMetrics>& estimators) {
  std::string found;
  for (const NamedMetrics& each : estimators) {
    if (left.starts_with(each.estimator + ".") && each.estimator.size() > found.size())
      found = each.estimator;
  }
  return found;
}

[[noreturn]] void throwUnknown(const std::string& text, const std::string& left,
                               const std::map<std::string, std::string>& known,
                               const std::vector<NamedMetrics>& estimators) {
  std::vector<std::string> candidates;
  for (const auto& [spelling, full] : known) candidates.push_back(spelling);
  const std::size_t dot = left.find('.');
  const bool metric_after_dot = dot != std::string::npos && known.contains(left.substr(dot + 1));
  if (metric_after_dot) {
    std::vector<std::string> names;
    for (const NamedMetrics& each : estimators) names.push_back(each.estimator);
    const std::string guess = nearest(left.substr(0, dot), names);
    throwUsage(text, "unknown estimator", left.substr(0, dot),
               guess.empty() ? "" : "did you mean " + guess + "?");
  }
  throwUsage(text, "unknown metric", left, "did you mean " + nearest(left, candidates) + "?");
}

bool holds(double value, Relation relation, double limit) {
  switch (relation) {
    case Relation::Less:
      return value < limit;
    case Relation::LessOrEqual:
      return value <= limit;
    case Relation::Greater:
      return value > limit;
    case Relation::GreaterOrEqual:
      return value >= limit;
  }
  return false;
}

const char* symbol(Relation relation) {
  switch (relation) {
    case Relation::Less:
      return "<";
    case Relation::LessOrEqual:
      return "<=";
    case Relation::Greater:
      return ">";
    case Relation::GreaterOrEqual:
      return ">=";
  }
  return "<";
}

RequirementResult checkOne(const Requirement& requirement, const NamedMetrics& estimator) {
  const auto found = estimator.values.find(requirement.metric);
  const std::optional<double> value = found == estimator.values.end() ? std::nullopt : found->second;
  const bool passed = value && holds(*value, requirement.relation, requirement.limit);
  const std::string shown = value ? compact(*value) : "no value in this run";
  return {passed, std::string(passed ? "pass  " : "FAIL  ") + estimator.estimator + ": " +
                      requirement.metric + " = " + shown + ", required " + symbol(requirement.relation) +
                      " " + compact(requirement.limit)};
}

}  // namespace

bool isOfASensor(const std::string& text) {
  constexpr std::array kKnownLater{"nis_", "sensors.", "windows.", "switching."};
  return std::any_of(kKnownLater.begin(), kKnownLater.end(),
                     [&](const char* part) { return text.find(part) != std::string::npos; });
}

Requirement parseRequirement(const std::string& text, const std::vector<NamedMetrics>& estimators) {
  const std::size_t at = text.find_first_of("<>");
  if (at == std::string::npos) throwUsage(text, "no comparison", text, "p95_xy<1.0");
  const bool or_equal = at + 1 < text.size() && text[at + 1] == '=';
  Requirement requirement;
  requirement.text = text;
  if (text[at] == '<') requirement.relation = or_equal ? Relation::LessOrEqual : Relation::Less;
  if (text[at] == '>') requirement.relation = or_equal ? Relation::GreaterOrEqual : Relation::Greater;
  requirement.limit = parsedLimit(text, trimmed(text.substr(at + (or_equal ? 2 : 1))));

  const std::map<std::string, std::string> known = spellings(estimators);
  const std::string left = trimmed(text.substr(0, at));
  requirement.estimator = known.contains(left) ? "" : leadingEstimator(left, estimators);
  const std::string metric =
      requirement.estimator.empty() ? left : left.substr(requirement.estimator.size() + 1);
  const auto found = known.find(metric);
  if (found == known.end()) throwUnknown(text, metric, known, estimators);
  requirement.metric = found->second;
  return requirement;
}

Requirement parseRequirement(const std::string& text, const RunSummary& run) {
  // a run without estimators still knows the names that every estimator has
  if (run.estimators.empty()) return parseRequirement(text, {{"", metrics({}, run.end - run.start)}});
  return parseRequirement(text, namedMetrics(run));
}

std::vector<RequirementResult> check(const Requirement& requirement,
                                     const std::vector<NamedMetrics>& estimators) {
  std::vector<RequirementResult> results;
  for (const NamedMetrics& estimator : estimators) {
    if (!requirement.estimator.empty() && estimator.estimator != requirement.estimator) continue;
    results.push_back(checkOne(requirement, estimator));
  }
  return results;
}

std::vector<RequirementResult> check(const Requirement& requirement, const RunSummary& run) {
  return check(requirement, namedMetrics(run));
}

}  // namespace pos::eval
