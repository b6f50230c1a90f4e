#include "pos/report/summary_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "pos/core/angle.hpp"

namespace pos::report {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json number(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}

Json statisticsJson(const eval::Statistics& s, double unit) {
  return {{"count", s.count},
          {"rmse", number(unit * s.rmse)},
          {"mean", number(unit * s.mean)},
          {"median", number(unit * s.median)},
          {"std", number(unit * s.std)},
          {"min", number(unit * s.min)},
          {"max", number(unit * s.max)},
          {"p50", number(unit * s.p50)},
          {"p68", number(unit * s.p68)},
          {"p90", number(unit * s.p90)},
          {"p95", number(unit * s.p95)},
          {"p99", number(unit * s.p99)}};
}

/// Every component by name, null where the truth does not allow it.
Json errorsJson(const eval::Evaluation& evaluation) {
  Json errors = Json::object();
  for (const eval::Component which : eval::kComponents) {
    const eval::Statistics* found = evaluation.find(which);
    const double unit = which == eval::Component::Yaw ? degrees(1.0) : 1.0;
    errors[std::string(name(which))] = found ? statisticsJson(*found, unit) : Json(nullptr);
  }
  return errors;
}

Json neesInto(Json consistency, const std::string& stem, const eval::NeesSummary& nees) {
  const bool known = nees.count > 0;
  const auto put = [&](const char* end, double value) {
    consistency[stem + end] = known ? number(value) : Json(nullptr);
  };
  put("_mean", nees.mean);
  put("_low", nees.bounds.low);
  put("_high", nees.bounds.high);
  put("_low_naive", nees.naive_bounds.low);
  put("_high_naive", nees.naive_bounds.high);
  put("_effective_samples", nees.effective_count);
  put("_sigma_factor", nees.sigmaFactor());
  consistency[stem + "_count"] = nees.count;
  return consistency;
}

Json consistencyJson(const eval::EstimatorSummary& estimator) {
  Json c = Json::object();
  if (estimator.evaluation) {
    const eval::Consistency& found = estimator.evaluation->consistency;
    c = neesInto(neesInto(std::move(c), "nees_xy", found.nees_xy), "nees_pose", found.nees_pose);
    c["truth_sigma_m"] = number(found.truth_sigma);
    c["without_covariance"] = found.without_covariance;
    c["inside_3_sigma"] = {{"x", number(found.inside_x)},
                           {"y", number(found.inside_y)},
                           {"along", number(found.inside_along)},
                           {"cross", number(found.inside_cross)},
                           {"yaw", number(found.inside_yaw)}};
  }
  for (const auto& [sensor, tally] : estimator.verdicts.sensors()) {
    c["nis_" + sensor + "_mean"] = number(tally.nisMean());
    if (tally.nis_count > 0) c["nis_" + sensor + "_dof"] = number(tally.nisDof());
  }
  return c;
}

Json tallyJson(const eval::Tally& tally) {
  Json j = Json::object();
  for (const Verdict verdict : kVerdicts) j[std::string(name(verdict))] = tally.count(verdict);
  j["gated_fraction"] = number(tally.gatedFraction());
  if (!tally.reasons.empty()) j["reasons"] = tally.reasons;
  return j;
}

Json verdictsJson(const eval::VerdictCounts& verdicts) {
  Json sensors = Json::object();
  for (const auto& [sensor, tally] : verdicts.sensors()) sensors[sensor] = tallyJson(tally);
  Json anchors = Json::object();
  for (const auto& [anchor, tally] : verdicts.anchors()) anchors[std::to_string(anchor)] = tallyJson(tally);
  return {{"total", tallyJson(verdicts.total())}, {"sensors", sensors}, {"anchors", anchors}};
}

Json associationJson(const eval::Association& a) {
  return {{"total", a.total},
          {"matched", a.matched},
          {"not_finite", a.not_finite},
          {"largest_gap_s", seconds(a.largest_gap)},
          {"truth_span_s", seconds(a.truth_span)},
          {"time_offset_s", seconds(a.time_offset)}};
}

Json alignmentJson(const eval::Alignment& a) {
  const auto& t = a.T_truth_estimate.translation;
  const auto& q = a.T_truth_estimate.rotation;
  return {{"mode", name(a.mode)},
          {"translation_m", {number(t.x()), number(t.y()), number(t.z())}},
          {"rotation_xyzw", {number(q.x()), number(q.y()), number(q.z()), number(q.w())}},
          {"yaw_deg", number(degrees(a.T_truth_estimate.yaw()))}};
}

Json fractionsJson(const eval::Evaluation& evaluation) {
  static constexpr std::array kKeys{"0.3_m", "0.5_m", "1_m", "2_m"};
  static_assert(kKeys.size() == eval::kErrorLimits.size());
  Json fractions = Json::object();
  const bool matched = evaluation.association.matched > 0;
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    fractions[kKeys[i]] = matched ? number(evaluation.fraction_under[i]) : Json(nullptr);
  }
  return fractions;
}

Json relativeJson(const std::vector<eval::RelativeError>& all) {
  Json list = Json::array();
  for (const eval::RelativeError& relative : all) {
    if (relative.translation.count == 0) continue;
    Json entry = Json::object();
    if (relative.length > 0.0) entry["length_m"] = relative.length;
    if (relative.duration > 0.0) entry["duration_s"] = relative.duration;
    entry["translation"] = statisticsJson(relative.translation, 1.0);
    entry["yaw"] = relative.yaw.count > 0 ? statisticsJson(relative.yaw, degrees(1.0)) : Json(nullptr);
    list.push_back(entry);
  }
  return list;
}

Json figuresJson(const eval::ResidualFigures& f) {
  return {{"count", f.count},
          {"mean_m", number(f.mean)},
          {"std_m", number(f.std)},
          {"median_m", number(f.median)},
          {"mad_sigma_m", number(f.mad_sigma)}};
}

Json residualsJson(const std::vector<eval::AnchorResiduals>& all) {
  Json anchors = Json::object();
  for (const eval::AnchorResiduals& anchor : all) {
    anchors[std::to_string(anchor.anchor)] = {{"applied", figuresJson(anchor.applied)},
                                              {"all", figuresJson(anchor.all)}};
  }
  return anchors;
}

Json diagnosticsJson(const Diagnostics& diagnostics) {
  Json values = Json::object();
  for (const NamedValue& v : diagnostics) {
    values[v.name] = {{"value", number(v.value)}, {"sigma", v.sigma > 0.0 ? number(v.sigma) : Json(nullptr)}};
  }
  return values;
}

Json computeJson(const eval::ComputeStats& compute, Duration log_span) {
  const bool timed = compute.count() > 0;
  const auto value = [timed](double v) { return timed ? number(v) : Json(nullptr); };
  return {{"us_per_measurement_p50", value(compute.microseconds(0.50))},
          {"us_per_measurement_p99", value(compute.microseconds(0.99))},
          {"us_per_measurement_max", value(1e6 * seconds(compute.max()))},
          {"total_s", value(seconds(compute.total()))},
          {"measurements", compute.count()},
          {"real_time_factor", value(compute.realTimeFactor(log_span))}};
}

Json intervalsJson(const eval::IntervalFigures& f) {
  return {{"right_share", number(f.rightShare())},
          {"right_share_clear", number(f.rightShareClear())},
          {"matched_share", f.matched_share},
          {"judged", f.judged},
          {"judged_clear", f.judged_clear},
          {"entry_time_rmse_s", number(f.entryTimeRmse())},
          {"entries", f.record.entries},
          {"exits", f.record.exits},
          {"branches", f.record.branches},
          {"branch_past_m", number(f.record.branch_past)},
          {"lost", f.record.lost},
          {"passages_refused", f.record.passages_refused}};
}

Json windowsJson(const std::vector<eval::WindowErrors>& windows) {
  Json all = Json::object();
  for (const eval::WindowErrors& window : windows) {
    Json components = Json::object();
    for (std::size_t i = 0; i < eval::kWindowComponents.size(); ++i) {
      const eval::WindowError& error = window.errors[i];
      Json figures = {{"mean", number(error.mean)}, {"rmse", number(error.rmse)}, {"max", number(error.max)}};
      figures["count"] = error.count;
      components[std::string(eval::kWindowComponents[i])] = error.count > 0 ? figures : Json(nullptr);
    }
    all[window.name] = components;
  }
  return all;
}

Json switchingJson(const eval::SwitchingFigures& f, Stamp start) {
  Json list = Json::array();
  for (const eval::ModeSwitch& each : f.switches) {
    list.push_back({{"change", each.change},
                    {"from", each.from},
                    {"to", each.to},
                    {"boundary_s", each.boundary ? number(seconds(*each.boundary - start)) : Json(nullptr)},
                    {"started_s", seconds(each.started - start)},
                    {"wait_s", number(each.wait())},
                    {"delay_s", number(each.delay())},
                    {"to_better_s", number(each.delayToBetter())}});
  }
  return {{"failed", f.failed()},
          {"mean_s", number(f.meanDelay())},
          {"max_s", number(f.maxDelay())},
          {"to_better_mean_s", number(f.meanDelayToBetter())},
          {"to_better_max_s", number(f.maxDelayToBetter())},
          {"switches", list}};
}

Json estimatorJson(const eval::EstimatorSummary& estimator, Stamp start) {
  Json e = {{"type", estimator.type}, {"estimates", estimator.estimates}};
  const auto& evaluation = estimator.evaluation;
  e["errors"] = evaluation ? errorsJson(*evaluation) : Json(nullptr);
  e["fraction_under"] = evaluation ? fractionsJson(*evaluation) : Json(nullptr);
  e["consistency"] = consistencyJson(estimator);
  e["verdicts"] = verdictsJson(estimator.verdicts);
  e["coverage"] = evaluation ? number(evaluation->association.coverage) : Json(nullptr);
  e["association"] = evaluation ? associationJson(evaluation->association) : Json(nullptr);
  e["alignment"] = evaluation ? alignmentJson(evaluation->alignment) : Json(nullptr);
  e["relative"] = evaluation ? relativeJson(evaluation->relative) : Json::array();
  e["residuals"] = residualsJson(estimator.residuals);
  e["diagnostics"] = diagnosticsJson(estimator.diagnostics);
  if (estimator.intervals) e["intervals"] = intervalsJson(*estimator.intervals);
  if (evaluation && !evaluation->windows.empty()) e["windows"] = windowsJson(evaluation->windows);
  if (estimator.switching) e["switching"] = switchingJson(*estimator.switching, start);
  return e;
}

Json runJson(const eval::RunSummary& run) {
  return {
      {"name", run.run},
      {"log", run.log},
      {"map", run.map},
      {"seed", run.seed},
      {"start_s", secondsSinceOrigin(run.start)},
      {"end_s", secondsSinceOrigin(run.end)},
      {"duration_s", seconds(run.end - run.start)},
      {"has_truth", run.has_truth},
      {"log_end",
       {{"damaged", run.log_end.damaged},
        {"objects", run.log_end.objects},
        {"byte", run.log_end.byte},
        {"message", run.log_end.message}}},
      {"error_definition",
       "estimate - truth, truth interpolated at the estimate's stamp; mean is signed, median, min, max and "
       "percentiles are of |error|, std divides by n; m, yaw in degrees"}};
}

Json wholeJson(const eval::RunSummary& run) {
  Json estimators = Json::object();
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    estimators[estimator.name] = estimatorJson(estimator, run.start);
  }
  return {{"format", "pos.summary/1"}, {"run", runJson(run)}, {"estimators", std::move(estimators)}};
}

std::string text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string summaryJson(const eval::RunSummary& run) {
  Json json = wholeJson(run);
  for (const eval::EstimatorSummary& estimator : run.estimators) {
    json["estimators"][estimator.name]["compute"] = computeJson(estimator.compute, run.end - run.start);
  }
  return text(json);
}

std::string repeatableSummaryJson(const eval::RunSummary& run) {
  return text(wholeJson(run));
}

}  // namespace pos::report
