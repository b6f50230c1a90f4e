#include "pos/report/summary_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "unit/report/demo_run.hpp"

namespace pos::report {

namespace {

using nlohmann::json;

const eval::RunSummary& demo() {
  static const eval::RunSummary run = demoRun();
  return run;
}

json schema() {
  std::ifstream file(std::string(POS_SOURCE_DIR) + "/docs/formats/summary.schema.json");
  return json::parse(file);
}

bool isOfType(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  return type == "null" && value.is_null();
}

/// Checks `value` against the parts of JSON Schema that ours uses: $ref, type, required, properties,
/// additionalProperties, items, const, enum.
void expectValid(const json& value, const json& rule, const json& root, const std::string& path) {
  if (rule.contains("$ref")) {
    const std::string reference = rule["$ref"].get<std::string>().substr(1);
    return expectValid(value, root.at(json::json_pointer(reference)), root, path);
  }
  if (rule.contains("type")) {
    const json types = rule["type"].is_array() ? rule["type"] : json::array({rule["type"]});
    bool fits = false;
    for (const json& type : types) fits = fits || isOfType(value, type.get<std::string>());
    EXPECT_TRUE(fits) << path << " is " << value.type_name() << ", not " << types;
  }
  if (rule.contains("const")) {
    EXPECT_EQ(value, rule["const"]) << path;
  }
  if (rule.contains("enum")) {
    EXPECT_THAT(rule["enum"], testing::Contains(value)) << path;
  }
  if (value.is_array() && rule.contains("items")) {
    for (const json& item : value) expectValid(item, rule["items"], root, path + "[]");
  }
  if (!value.is_object()) return;
  for (const json& key : rule.value("required", json::array())) {
    EXPECT_TRUE(value.contains(key.get<std::string>())) << path << " lacks " << key;
  }
  for (const auto& [key, child] : value.items()) {
    const json properties = rule.value("properties", json::object());
    if (properties.contains(key)) {
      expectValid(child, properties[key], root, path + "." + key);
    } else if (rule.contains("additionalProperties")) {
      expectValid(child, rule["additionalProperties"], root, path + "." + key);
    }
  }
}

}  // namespace

TEST(SummaryJson, KeepsToItsSchema) {
  expectValid(json::parse(summaryJson(demo())), schema(), schema(), "summary");
  expectValid(json::parse(repeatableSummaryJson(demo())), schema(), schema(), "summary");
}

TEST(SummaryJson, HasEveryPromisedFigure) {
  const json all = json::parse(summaryJson(demo()));
  const json& e = all["estimators"]["range_odometry"];
  for (const char* component : {"xy", "x", "y", "along", "cross", "yaw"}) {
    for (const char* figure : {"rmse", "mean", "median", "std", "max", "p50", "p68", "p90", "p95", "p99"}) {
      EXPECT_TRUE(e["errors"][component][figure].is_number()) << component << "." << figure;
    }
  }
  EXPECT_TRUE(e["errors"]["z"].is_null());
  for (const char* figure : {"nees_xy_mean", "nees_xy_low", "nees_xy_high", "nis_uwb_mean"}) {
    EXPECT_TRUE(e["consistency"][figure].is_number()) << figure;
  }
  for (const char* figure : {"us_per_measurement_p50", "us_per_measurement_p99", "real_time_factor"}) {
    EXPECT_TRUE(e["compute"][figure].is_number()) << figure;
  }
  EXPECT_TRUE(e["coverage"].is_number());
  EXPECT_EQ(e["verdicts"]["sensors"]["uwb"]["applied"].get<int>() +
                e["verdicts"]["sensors"]["uwb"]["gated"].get<int>(),
            4 * 1997);
  EXPECT_EQ(all["run"]["log_end"]["damaged"], true);
}

TEST(SummaryJson, YawIsInDegrees) {
  const eval::Statistics* yaw = demo().estimators[0].evaluation->find(eval::Component::Yaw);
  const json all = json::parse(summaryJson(demo()));
  EXPECT_NEAR(all["estimators"]["range_odometry"]["errors"]["yaw"]["rmse"].get<double>(),
              yaw->rmse * 180.0 / kPi, 1e-12);
}

TEST(SummaryJson, WithoutComputeTimesItIsTheSameEveryTime) {
  eval::RunSummary again = demoRun();
  for (auto& estimator : again.estimators) estimator.compute.add(durationFromSeconds(1.0));
  EXPECT_NE(summaryJson(demo()), summaryJson(again));
  EXPECT_EQ(repeatableSummaryJson(demo()), repeatableSummaryJson(again));
}

TEST(SummaryJson, WithoutTruthErrorsAreNull) {
  eval::RunSummary run = demo();
  run.has_truth = false;
  for (auto& estimator : run.estimators) estimator.evaluation.reset();
  const json all = json::parse(summaryJson(run));
  expectValid(all, schema(), schema(), "summary");
  EXPECT_TRUE(all["estimators"]["mcl"]["errors"].is_null());
  EXPECT_TRUE(all["estimators"]["mcl"]["coverage"].is_null());
  EXPECT_TRUE(all["estimators"]["mcl"]["consistency"]["nis_uwb_mean"].is_number());
}

TEST(SummaryJson, SurvivesNumbersAndNamesThatAreNone) {
  eval::RunSummary run = demo();
  run.run = "bad \xff name";
  run.estimators[0].diagnostics.push_back({"broken", std::nan(""), std::nan("")});
  const json all = json::parse(summaryJson(run));
  EXPECT_TRUE(all["estimators"]["range_odometry"]["diagnostics"]["broken"]["value"].is_null());
  EXPECT_EQ(json::parse(summaryJson({}))["estimators"], json::object());
}

}  // namespace pos::report
