#include "pos/eval/requirement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pos/core/error.hpp"

namespace pos::eval {

namespace {

using testing::HasSubstr;

EstimatorRecord record(const std::string& name, double error) {
  EstimatorRecord r;
  r.name = name;
  r.type = "test";
  for (int i = 0; i <= 100; ++i) {
    r.estimates.push_back(
        planarEstimate(stampFromSeconds(0.1 * i), {0.1 * i, error, 0.02}, Matrix<3, 3>::Identity()));
    r.verdicts.add("uwb", 1, {.verdict = Verdict::Applied, .dof = 1, .nis = 1.5});
  }
  return r;
}

RunSummary twoEstimators() {
  Truth truth;
  for (int i = 0; i <= 10; ++i)
    truth.poses.push_back({stampFromSeconds(i), Pose3::fromPlanar({1.0 * i, 0.0, 0.0})});
  RunSummary run;
  run.end = stampFromSeconds(10.0);
  run.has_truth = true;
  run.estimators = {summarise(record("ekf", 0.5), &truth, run.start),
                    summarise(record("v2.mcl", 2.0), &truth, run.start)};
  return run;
}

std::string complaintOf(const std::string& text) {
  try {
    parseRequirement(text, twoEstimators());
  } catch (const UsageError& error) {
    EXPECT_EQ(error.exitCode(), 2);
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST(Requirement, HoldsForEveryEstimatorWhenNoneIsNamed) {
  const RunSummary run = twoEstimators();
  const Requirement r = parseRequirement("p95_xy<1.0", run);
  EXPECT_EQ(r.metric, "errors.xy.p95");
  const auto results = check(r, run);
  ASSERT_EQ(results.size(), 2U);
  EXPECT_TRUE(results[0].passed);
  EXPECT_FALSE(results[1].passed);
  EXPECT_EQ(results[0].line, "pass  ekf: errors.xy.p95 = 0.5, required < 1");
  EXPECT_EQ(results[1].line, "FAIL  v2.mcl: errors.xy.p95 = 2, required < 1");
}

TEST(Requirement, AcceptsPathsShortFormsAndNamesWithDots) {
  const RunSummary run = twoEstimators();
  for (const char* text :
       {"ekf.xy.rmse<=0.5", "ekf.errors.xy.rmse <= 0.5", "ekf.rmse_xy<0.51", "rmse_xy>0.49",
        "v2.mcl.xy.rmse>=2", "nees_xy_mean<10", "ekf.consistency.nees_xy_mean<1",
        "consistency.nis_uwb_mean<2", "nis_uwb_mean<2", "coverage>0.99", "gated_fraction<=0",
        "verdicts.total.applied>=101", "verdicts.sensors.uwb.gated<1", "ekf.under_1_m>0.99",
        "cross.mean>=0.5", "rmse_yaw<1.2", "yaw.rmse>1.1"}) {
    for (const RequirementResult& result : check(parseRequirement(text, run), run)) {
      EXPECT_TRUE(result.passed) << text << ": " << result.line;
    }
  }
  EXPECT_EQ(check(parseRequirement("v2.mcl.xy.rmse>=2", run), run).size(), 1U);
}

TEST(Requirement, BoundsAreStrictOrNotAsWritten) {
  const RunSummary run = twoEstimators();
  EXPECT_FALSE(check(parseRequirement("ekf.verdicts.total.applied<101", run), run)[0].passed);
  EXPECT_TRUE(check(parseRequirement("ekf.verdicts.total.applied<=101", run), run)[0].passed);
  EXPECT_FALSE(check(parseRequirement("ekf.verdicts.total.applied>101", run), run)[0].passed);
  EXPECT_TRUE(check(parseRequirement("ekf.verdicts.total.applied>=101", run), run)[0].passed);
}

TEST(Requirement, UnknownMetricSuggestsTheNearest) {
  EXPECT_THAT(complaintOf("nes_xy_mean<1"), HasSubstr("did you mean nees_xy_mean?"));
  EXPECT_THAT(complaintOf("ekf.rsme_xy<1"), HasSubstr("did you mean rmse_xy?"));
}

TEST(Requirement, UnknownEstimatorSuggestsTheNearest) {
  EXPECT_THAT(complaintOf("efk.rmse_xy<1"), HasSubstr("did you mean ekf?"));
}

TEST(Requirement, RefusesWhatIsNoComparison) {
  EXPECT_THAT(complaintOf("p95_xy"), HasSubstr("no comparison"));
  EXPECT_THAT(complaintOf("p95_xy<one"), HasSubstr("not a number"));
  EXPECT_THAT(complaintOf("p95_xy<"), HasSubstr("not a number"));
  EXPECT_THAT(complaintOf("p95_xy<1.0m"), HasSubstr("not a number"));
  EXPECT_THAT(complaintOf("<1"), HasSubstr("unknown metric"));
}

TEST(Requirement, FigureWithoutAValueMisses) {
  RunSummary run = twoEstimators();
  for (EstimatorSummary& estimator : run.estimators) estimator.evaluation.reset();
  const auto results = check(parseRequirement("p95_xy<1000", run), run);
  ASSERT_EQ(results.size(), 2U);
  EXPECT_FALSE(results[0].passed);
  EXPECT_THAT(results[0].line, HasSubstr("no value in this run"));
}

TEST(Summarise, BestIsTheSmallestErrorAndNoTruthGivesNoEvaluation) {
  RunSummary run = twoEstimators();
  EXPECT_EQ(run.best()->name, "ekf");
  std::swap(run.estimators[0], run.estimators[1]);
  EXPECT_EQ(run.best()->name, "ekf");
  const EstimatorSummary blind = summarise(record("blind", 1.0), nullptr, run.start);
  EXPECT_FALSE(blind.evaluation);
  EXPECT_FALSE(blind.path.empty());
  EXPECT_EQ(RunSummary{}.best(), nullptr);
}

TEST(Summarise, EmptyTruthOrNoMatchHoldsNoFigures) {
  const Truth empty;
  EXPECT_FALSE(summarise(record("a", 1.0), &empty, {}).evaluation);
  Truth elsewhere;
  elsewhere.poses = {{stampFromSeconds(1000.0), {}}, {stampFromSeconds(1001.0), {}}};
  const EstimatorSummary none = summarise(record("a", 1.0), &elsewhere, {});
  ASSERT_TRUE(none.evaluation);
  EXPECT_EQ(none.evaluation->association.matched, 0U);
  EXPECT_TRUE(none.evaluation->errors.empty());
  EXPECT_FALSE(none.rmseXy());
}

TEST(Summarise, StatisticsAreOfAllSamplesThoughPlotsAreThinned) {
  Truth truth;
  for (int i = 0; i <= 10; ++i)
    truth.poses.push_back({stampFromSeconds(i), Pose3::fromPlanar({1.0 * i, 0.0, 0.0})});
  EvaluationOptions options;
  options.plot_points = 20;
  const EstimatorSummary s = summarise(record("a", 1.0), &truth, {}, options);
  EXPECT_EQ(s.evaluation->find(Component::Xy)->count, 101U);
  EXPECT_LE(s.evaluation->xy.value.size(), 20U);
  EXPECT_EQ(s.evaluation->along.sigma.size(), s.evaluation->along.value.size());
}

}  // namespace pos::eval
