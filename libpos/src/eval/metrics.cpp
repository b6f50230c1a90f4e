#include "pos/eval/metrics.hpp"

#include <array>
#include <cstdint>
#include <string_view>

#include "compact_number.hpp"
#include "pos/core/angle.hpp"

namespace pos::eval {

namespace {

using Metrics = std::map<std::string, std::optional<double>>;

struct Figure {
  const char* name;
  double Statistics::*field;
};
constexpr std::array kFigures{Figure{"rmse", &Statistics::rmse},     Figure{"mean", &Statistics::mean},
                              Figure{"median", &Statistics::median}, Figure{"std", &Statistics::std},
                              Figure{"min", &Statistics::min},       Figure{"max", &Statistics::max},
                              Figure{"p50", &Statistics::p50},       Figure{"p68", &Statistics::p68},
                              Figure{"p90", &Statistics::p90},       Figure{"p95", &Statistics::p95},
                              Figure{"p99", &Statistics::p99}};

Metrics errorMetrics(const EstimatorSummary& estimator) {
  Metrics all;
  for (const Component which : kComponents) {
    const Statistics* found = estimator.evaluation ? estimator.evaluation->find(which) : nullptr;
    const double unit = which == Component::Yaw ? degrees(1.0) : 1.0;
    for (const Figure& figure : kFigures) {
      auto& value = all["errors." + std::string(name(which)) + "." + figure.name];
      if (found) value = unit * found->*figure.field;
    }
  }
  const bool matched = estimator.evaluation && estimator.evaluation->association.matched > 0;
  for (std::size_t i = 0; i < kErrorLimits.size(); ++i) {
    auto& value = all["fraction_under." + compact(kErrorLimits[i]) + "_m"];
    if (matched) value = estimator.evaluation->fraction_under[i];
  }
  return all;
}

Metrics neesMetrics(const std::string& stem, const NeesSummary* nees) {
  Metrics all;
  const bool known = nees != nullptr && nees->count > 0;
  const auto put = [&](const char* end, double value) {
    all["consistency." + stem + end] = known ? std::optional(value) : std::nullopt;
  };
  put("_mean", known ? nees->mean : 0.0);
  put("_low", known ? nees->bounds.low : 0.0);
  put("_high", known ? nees->bounds.high : 0.0);
  put("_sigma_factor", known ? nees->sigmaFactor() : 0.0);
  return all;
}

Metrics verdictMetrics(const VerdictCounts& verdicts) {
  Metrics all;
  const auto put = [&all](const std::string& stem, const Tally& tally) {
    for (const Verdict verdict : kVerdicts) {
      all[stem + std::string(name(verdict))] = static_cast<double>(tally.count(verdict));
    }
    all[stem + "gated_fraction"] = tally.gatedFraction();
  };
  put("verdicts.total.", verdicts.total());
  for (const auto& [sensor, tally] : verdicts.sensors()) {
    put("verdicts.sensors." + sensor + ".", tally);
    all["consistency.nis_" + sensor + "_mean"] = tally.nisMean();
  }
  return all;
}

Metrics intervalMetrics(const IntervalFigures& f) {
  Metrics all;
  all["intervals.right_share"] = f.rightShare();
  all["intervals.right_share_clear"] = f.rightShareClear();
  all["intervals.matched_share"] = f.matched_share;
  all["intervals.entry_time_rmse_s"] = f.entryTimeRmse();
  all["intervals.branch_past_m"] = f.record.branch_past;
  const auto put = [&](const char* name, std::uint64_t count) {
    all[std::string("intervals.") + name] = static_cast<double>(count);
  };
  put("entries", f.record.entries);
  put("exits", f.record.exits);
  put("branches", f.record.branches);
  put("lost", f.record.lost);
  put("passages_refused", f.record.passages_refused);
  return all;
}

Metrics windowMetrics(const Evaluation& evaluation) {
  Metrics all;
  for (const WindowErrors& window : evaluation.windows) {
    for (std::size_t i = 0; i < kWindowComponents.size(); ++i) {
      const WindowError& error = window.errors[i];
      const auto put = [&](const char* figure, double value) {
        all["windows." + window.name + "." + std::string(kWindowComponents[i]) + "." + figure] =
            error.count > 0 ? std::optional(value) : std::nullopt;
      };
      put("mean", error.mean);
      put("rmse", error.rmse);
      put("max", error.max);
    }
  }
  return all;
}

Metrics switchingMetrics(const SwitchingFigures& f) {
  Metrics all;
  all["switching.switches"] = static_cast<double>(f.switches.size());
  all["switching.failed"] = static_cast<double>(f.failed());
  all["switching.mean_s"] = f.meanDelay();
  all["switching.max_s"] = f.maxDelay();
  all["switching.to_better_mean_s"] = f.meanDelayToBetter();
  all["switching.to_better_max_s"] = f.maxDelayToBetter();
  for (std::size_t i = 0; i < f.switches.size(); ++i) {
    const std::string stem = "switching." + std::to_string(i + 1) + ".";
    all[stem + "delay_s"] = f.switches[i].delay();
    all[stem + "to_better_s"] = f.switches[i].delayToBetter();
    all[stem + "wait_s"] = f.switches[i].wait();
  }
  return all;
}

}  // namespace

std::map<std::string, std::optional<double>> metrics(const EstimatorSummary& estimator, Duration log_span) {
  const Evaluation* evaluation = estimator.evaluation ? &*estimator.evaluation : nullptr;
  Metrics all = errorMetrics(estimator);
  all.merge(neesMetrics("nees_xy", evaluation ? &evaluation->consistency.nees_xy : nullptr));
  all.merge(neesMetrics("nees_pose", evaluation ? &evaluation->consistency.nees_pose : nullptr));
  all.merge(verdictMetrics(estimator.verdicts));
  all["coverage"] = evaluation ? std::optional(evaluation->association.coverage) : std::nullopt;
  if (estimator.intervals) all.merge(intervalMetrics(*estimator.intervals));
  if (evaluation) all.merge(windowMetrics(*evaluation));
  if (estimator.switching) all.merge(switchingMetrics(*estimator.switching));
  const bool timed = estimator.compute.count() > 0;
  const auto put = [&](const char* key, double value) {
    all[std::string("compute.") + key] = timed ? std::optional(value) : std::nullopt;
  };
  put("us_per_measurement_p50", estimator.compute.microseconds(0.50));
  put("us_per_measurement_p99", estimator.compute.microseconds(0.99));
  put("real_time_factor", estimator.compute.realTimeFactor(log_span));
  return all;
}

}  // namespace pos::eval
