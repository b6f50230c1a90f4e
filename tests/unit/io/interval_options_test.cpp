#include "pos/io/interval_options.hpp"

#include <gtest/gtest.h>

#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "pos/io/run_config.hpp"

namespace pos::io {
namespace {

RunConfig runWith(const std::string& intervals) {
  const std::string text =
      "schema: 1\nname: n\nlog: {file: a.rawlog}\n" + intervals +
      "estimators:\n  - {name: a, type: dead_reckoning}\n  - {name: b, type: dead_reckoning}\n";
  return runConfigFrom(parseYaml(text, "run.yaml"), {});
}

}  // namespace

TEST(IntervalsConfig, WithoutTheSectionNothingIsEvaluated) {
  EXPECT_FALSE(runWith("").intervals);
}

TEST(IntervalsConfig, DefaultsAreThoseOfTheModules) {
  const RunConfig config = runWith("intervals: {}\n");
  ASSERT_TRUE(config.intervals);
  EXPECT_NEAR(config.intervals->match().heading_sigma, interval::MatchRules{}.heading_sigma, 1e-12);
  EXPECT_EQ(config.intervals->match().commit, interval::MatchRules{}.commit);
  EXPECT_EQ(config.intervals->rules().certain, interval::IntervalRules{}.certain);
  EXPECT_EQ(config.intervals->rules().listed, interval::IntervalRules{}.listed);
  EXPECT_EQ(config.intervals->aid().rate, interval::RoadAidRules{}.rate);
  EXPECT_EQ(config.intervals->division().straight_within, map::DivisionRules{}.straight_within);
  EXPECT_FALSE(config.intervals->aids("a"));
  EXPECT_EQ(config.intervals->passagesOf("a"), PassageUse::AsTold);
}

TEST(IntervalsConfig, OneEstimatorMayDifferFromTheOthers) {
  const RunConfig config = runWith(
      "intervals:\n  aiding: true\n  passages: checked\n  merge: 3\n  heading_sigma_deg: 4\n"
      "  estimators: [{estimator: b, aiding: false, passages: none}]\n");
  EXPECT_TRUE(config.intervals->aids("a"));
  EXPECT_FALSE(config.intervals->aids("b"));
  EXPECT_EQ(config.intervals->passagesOf("a"), PassageUse::Checked);
  EXPECT_EQ(config.intervals->passagesOf("b"), PassageUse::None);
  EXPECT_EQ(config.intervals->division().merge, 3);
  EXPECT_NEAR(config.intervals->match().heading_sigma, radians(4.0), 1e-12);
  EXPECT_EQ(runConfigFrom(parseYaml(resolvedYaml(config), "again.yaml"), {}).intervals, config.intervals);
}

TEST(IntervalsConfig, MistakesAreRefused) {
  EXPECT_THROW(runWith("intervals: {aidng: true}\n"), ConfigError);
  EXPECT_THROW(runWith("intervals: {aiding_rate_hz: 2}\n"), ConfigError);
  EXPECT_THROW(runWith("intervals: {commit_probability: 1}\n"), ConfigError);
  EXPECT_THROW(runWith("intervals: {estimators: [{estimator: c}]}\n"), ConfigError);
  EXPECT_THROW(runWith("intervals: {estimators: [{estimator: a}, {estimator: a}]}\n"), ConfigError);
}

}  // namespace pos::io
