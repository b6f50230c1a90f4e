#include "pos/report/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "pos/core/angle.hpp"
#include "pos/report/text.hpp"

namespace pos::report {

namespace {

using eval::Component;
using eval::EstimatorSummary;
using eval::Statistics;

struct Column {
  std::string title;
  std::function<std::string(const EstimatorSummary&)> text;
  /// Smaller is better; nothing keeps an estimator out of the contest. Empty: the column has no best.
  std::function<std::optional<double>(const EstimatorSummary&)> cost;
};

Column errorColumn(const std::string& title, Component component, double Statistics::*field) {
  const double unit = component == Component::Yaw ? degrees(1.0) : 1.0;
  const auto value = [=](const EstimatorSummary& e) -> std::optional<double> {
    const Statistics* found = e.evaluation ? e.evaluation->find(component) : nullptr;
    return found ? std::optional(unit * found->*field) : std::nullopt;
  };
  const auto text = [value](const EstimatorSummary& e) {
    const auto v = value(e);
    return v ? rounded(*v) : std::string(kNoValue);
  };
  return {title, text, value};
}

const eval::NeesSummary* neesOf(const EstimatorSummary& e) {
  return e.evaluation && e.evaluation->consistency.nees_xy.count > 0 ? &e.evaluation->consistency.nees_xy
                                                                     : nullptr;
}

Column neesColumn() {
  return {"NEES xy [95 %]",
          [](const EstimatorSummary& e) {
            const auto* nees = neesOf(e);
            if (nees == nullptr) return std::string(kNoValue);
            return rounded(nees->mean) + " [" + rounded(nees->bounds.low) + ".." +
                   rounded(nees->bounds.high) + "]";
          },
          [](const EstimatorSummary& e) -> std::optional<double> {
            const auto* nees = neesOf(e);
            return nees != nullptr && nees->mean > 0.0
                       ? std::optional(std::abs(std::log(nees->sigmaFactor())))
                       : std::nullopt;
          }};
}

std::vector<Column> columns() {
  return {
      errorColumn("xy rmse m", Component::Xy, &Statistics::rmse),
      errorColumn("median m", Component::Xy, &Statistics::median),
      errorColumn("p95 m", Component::Xy, &Statistics::p95),
      errorColumn("max m", Component::Xy, &Statistics::max),
      errorColumn("along m", Component::Along, &Statistics::rmse),
      errorColumn("cross m", Component::Cross, &Statistics::rmse),
      errorColumn("yaw deg", Component::Yaw, &Statistics::rmse),
      neesColumn(),
      {"gated", [](const EstimatorSummary& e) { return percent(e.verdicts.total().gatedFraction()); }, {}},
      {"coverage",
       [](const EstimatorSummary& e) {
         return e.evaluation ? percent(e.evaluation->association.coverage) : std::string(kNoValue);
       },
       [](const EstimatorSummary& e) {
         return e.evaluation ? std::optional(-e.evaluation->association.coverage) : std::nullopt;
       }},
      {"us/meas",
       [](const EstimatorSummary& e) {
         return e.compute.count() > 0 ? rounded(e.compute.microseconds(0.5)) : std::string(kNoValue);
       },
       [](const EstimatorSummary& e) {
         return e.compute.count() > 0 ? std::optional(e.compute.microseconds(0.5)) : std::nullopt;
       }}};
}

/// The best cost of a column, or nothing where there is no contest.
std::optional<double> bestCost(const Column& column, const std::vector<EstimatorSummary>& estimators) {
  if (!column.cost) return std::nullopt;
  std::vector<double> costs;
  for (const EstimatorSummary& estimator : estimators) {
    if (const auto cost = column.cost(estimator)) costs.push_back(*cost);
  }
  if (costs.size() < 2) return std::nullopt;
  const auto [low, high] = std::minmax_element(costs.begin(), costs.end());
  return *low < *high ? std::optional(*low) : std::nullopt;
}

std::string padded(const std::string& text, std::size_t width, bool to_the_left) {
  const std::size_t length = characterCount(text);
  const std::string space(width > length ? width - length : 0, ' ');
  return to_the_left ? text + space : space + text;
}

std::string factorText(double factor) {
  return fixed(factor, factor < 10.0 ? 1 : 0);
}

std::string neesWarning(const EstimatorSummary& e) {
  const eval::NeesSummary* nees = neesOf(e);
  if (nees == nullptr) return "";
  const std::string figures = " (errors against its own sigmas; NEES " + rounded(nees->mean) +
                              ", honest would be " + rounded(nees->bounds.low) + " to " +
                              rounded(nees->bounds.high) + ").";
  if (nees->honesty() == eval::Honesty::TooSure) {
    return e.name + " is too sure of itself by a factor ~" + factorText(nees->sigmaFactor()) + figures;
  }
  if (nees->honesty() == eval::Honesty::TooCautious) {
    return e.name + " is too cautious by a factor ~" + factorText(1.0 / std::max(nees->sigmaFactor(), 1e-6)) +
           figures;
  }
  return "";
}

/// What a truth that is not perfect would explain of the overconfidence above; empty when there is none, or
/// when the truth's own accuracy was counted already.
std::string truthWarning(const eval::RunSummary& run) {
  std::string list;
  for (const EstimatorSummary& e : run.estimators) {
    const eval::NeesSummary* nees = neesOf(e);
    if (nees == nullptr || nees->honesty() != eval::Honesty::TooSure) continue;
    if (e.evaluation->consistency.truth_sigma > 0.0) continue;
    const double sigma = nees->explainingTruthSigma(e.rmseXy().value_or(0.0));
    list += (list.empty() ? "" : ", ") + e.name + " " + fixed(sigma, 2) + " m";
  }
  if (list.empty()) return "";
  return "The truth was taken as perfect. One that is itself wrong by about this much per axis would alone "
         "look like "
         "the overconfidence above: " +
         list + ". If yours is no better, say so with evaluation.truth_sigma_m.";
}

std::vector<std::string> estimatorWarnings(const EstimatorSummary& e, Duration log_span) {
  std::vector<std::string> all;
  if (e.estimates == 0) all.push_back(e.name + " recorded no estimate.");
  if (e.evaluation && e.estimates > 0) {
    const eval::Association& a = e.evaluation->association;
    if (a.matched == 0) {
      all.push_back(e.name + " has no estimate at a time that the truth covers; nothing of it was judged.");
    } else if (a.coverage < 0.95) {
      all.push_back(e.name + " covers only " + percent(a.coverage) +
                    " of the truth's time span (largest gap " + durationText(a.largest_gap) +
                    "); its errors say nothing about the rest.");
    }
    if (a.not_finite > 0) {
      all.push_back(e.name + " recorded " + grouped(a.not_finite) +
                    " poses that are no numbers; they are left out.");
    }
    if (a.matched > 0 && e.evaluation->consistency.nees_xy.count == 0) {
      all.push_back(e.name + " gives no usable covariance, so its honesty cannot be judged.");
    }
  }
  if (const std::string text = neesWarning(e); !text.empty()) all.push_back(text);
  const eval::Tally total = e.verdicts.total();
  if (total.gatedFraction() > 0.2) {
    all.push_back(e.name + " gated " + percent(total.gatedFraction()) + " of the readings it could use.");
  }
  if (e.compute.count() > 0 && e.compute.realTimeFactor(log_span) < 1.0) {
    all.push_back(e.name + " is slower than real time (" + rounded(e.compute.realTimeFactor(log_span)) +
                  " times real time on this machine).");
  }
  return all;
}

}  // namespace

Comparison comparison(const eval::RunSummary& run) {
  Comparison table;
  table.columns.push_back("estimator");
  table.rows.resize(run.estimators.size());
  for (std::size_t i = 0; i < run.estimators.size(); ++i) table.rows[i].push_back({run.estimators[i].name});
  for (const Column& column : columns()) {
    table.columns.push_back(column.title);
    const auto best = bestCost(column, run.estimators);
    for (std::size_t i = 0; i < run.estimators.size(); ++i) {
      const EstimatorSummary& estimator = run.estimators[i];
      const bool is_best = best && column.cost(estimator) == best;
      table.rows[i].push_back({column.text(estimator), is_best});
    }
  }
  return table;
}

std::string truthSigmaNote(const eval::RunSummary& run) {
  for (const EstimatorSummary& e : run.estimators) {
    if (!e.evaluation || e.evaluation->consistency.truth_sigma <= 0.0) continue;
    return "NEES counts the truth as good to " + rounded(e.evaluation->consistency.truth_sigma) +
           " m per axis (evaluation.truth_sigma_m).";
  }
  return "";
}

std::string tableText(const Comparison& table) {
  std::vector<std::vector<std::string>> lines{table.columns};
  bool any_best = false;
  for (const auto& row : table.rows) {
    lines.emplace_back();
    for (const ComparisonCell& cell : row) {
      lines.back().push_back(cell.best ? "*" + cell.text : cell.text);
      any_best = any_best || cell.best;
    }
  }
  std::vector<std::size_t> widths(table.columns.size(), 0);
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], characterCount(line[c]));
  }
  std::string text;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    for (std::size_t c = 0; c < lines[l].size(); ++c) {
      text += (c > 0 ? "  " : "") + padded(lines[l][c], widths[c], c == 0);
    }
    text += "\n";
    if (l == 0) {
      for (std::size_t c = 0; c < widths.size(); ++c)
        text += (c > 0 ? "  " : "") + std::string(widths[c], '-');
      text += "\n";
    }
  }
  return any_best ? text + "* best in its column\n" : text;
}

std::string comparisonTable(const eval::RunSummary& run) {
  std::string text = tableText(comparison(run));
  if (const std::string note = truthSigmaNote(run); !note.empty()) text += note + "\n";
  return text;
}

std::vector<std::string> warnings(const eval::RunSummary& run) {
  std::vector<std::string> all;
  if (run.log_end.damaged) {
    all.push_back("The log is damaged: reading ended at byte " + grouped(run.log_end.byte) + " after " +
                  grouped(run.log_end.objects) + " objects" +
                  (run.log_end.message.empty() ? "." : " (" + run.log_end.message + ").") +
                  " Everything here covers only the part before.");
  }
  if (!run.has_truth) all.push_back("The log holds no truth: errors and honesty cannot be told.");
  if (run.estimators.empty()) all.push_back("The run has no estimator.");
  for (const EstimatorSummary& estimator : run.estimators) {
    const std::vector<std::string> its = estimatorWarnings(estimator, run.end - run.start);
    all.insert(all.end(), its.begin(), its.end());
  }
  if (const std::string text = truthWarning(run); !text.empty()) all.push_back(text);
  return all;
}

}  // namespace pos::report
