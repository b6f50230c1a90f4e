// `pos map`: what its verbs print, write and return.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "replay/run_pos.hpp"

namespace pos::replay {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class MapVerbs : public ::testing::Test {
 protected:
  static std::string site(const std::string& name) { return source("maps/" + name + "/map.yaml").string(); }
  static std::string broken(const std::string& name) {
    return source("tests/data/broken_maps/" + name + ".yaml").string();
  }
  json jsonOf(const std::vector<std::string>& arguments) const {
    const RunResult run = bench_.pos(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out, nullptr, false);
  }
  Bench bench_;
};

}  // namespace

TEST_F(MapVerbs, CheckTellsOrderFromErrorsAndWarnings) {
  const RunResult good = bench_.pos({"map", "check", site("interval_demo"), site("shift_mine")});
  EXPECT_EQ(good.exit_code, 0);
  EXPECT_THAT(good.out, HasSubstr("in order"));
  const RunResult bad = bench_.pos({"map", "check", broken("anchor_outside")});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_THAT(bad.out, HasSubstr("error anchor_outside: anchor 7 is 9.50 m outside"));
  EXPECT_THAT(bad.out, HasSubstr("at:  x 50.00, y 12.00, z 2.00 m"));
  EXPECT_EQ(bench_.pos({"map", "check", broken("steep_grade")}).exit_code, 0) << "a warning";
  EXPECT_EQ(bench_.pos({"map", "check", "no_such_map.yaml"}).exit_code, 3);
}

TEST_F(MapVerbs, CheckWritesJsonWithPlaceAndRemedy) {
  const RunResult run = bench_.pos({"map", "check", broken("gap"), "--json"});
  EXPECT_EQ(run.exit_code, 3);
  const json finding = json::parse(run.out)["findings"][0];
  EXPECT_EQ(finding["check"], "gap");
  EXPECT_EQ(finding["severity"], "error");
  EXPECT_NEAR(finding["place"]["y_m"].get<double>(), 1.5, 1e-9);
  EXPECT_FALSE(finding["remedy"].get<std::string>().empty());
}

TEST_F(MapVerbs, ThePapersRoadwaysAreTooNarrowForItsVehicle) {
  const RunResult run = bench_.pos({"map", "check", site("mock_shaft"), "--vehicle", "1.245x1.3"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.out, HasSubstr("needs 3.79 m"));
  EXPECT_THAT(run.out, HasSubstr("has 2.20 m of width for one vehicle"));
  EXPECT_EQ(bench_.pos({"map", "check", site("mock_shaft"), "--vehicle", "wide"}).exit_code, 2);
}

/// One wall, 50 m apart, radio of 60 m in a roadway of 5 m: docs/math/coverage.md.
TEST_F(MapVerbs, CoverageOfTheDemoAgreesWithTheTable) {
  const json coverage = jsonOf({"map", "coverage", site("interval_demo"), "--json", "--csv", "samples.csv"});
  EXPECT_NEAR(coverage["whole"]["along_median_m"].get<double>(), 0.07, 0.007);
  EXPECT_NEAR(coverage["whole"]["across_median_m"].get<double>(), 0.54, 0.054);
  EXPECT_THAT(bench_.read("samples.csv"), HasSubstr("roadway,chainage_m,x_m,y_m,z_m,anchors,along_sigma_m"));
}

TEST_F(MapVerbs, PlanIsWrittenAsAMapThatCoversAsPromised) {
  bench_.write(
      "bare.yaml",
      "schema: 2\nname: bare\nroadways:\n  - id: R\n    width_m: 5\n    height_m: 3\n    centreline:\n"
      "      - {x_m: 0, y_m: 0, z_m: 0}\n      - {x_m: 300, y_m: 0, z_m: 0}\n");
  const json plan = jsonOf({"map", "plan-anchors", "bare.yaml", "--along", "0.2", "--across", "0.9",
                            "--range", "80", "--out", "planned.yaml", "--json"});
  EXPECT_TRUE(plan["met"].get<bool>());
  const json coverage = jsonOf({"map", "coverage", "planned.yaml", "--range", "80", "--step", "5", "--json"});
  EXPECT_LE(coverage["whole"]["across_p90_m"].get<double>(), 0.9);
  const json info = jsonOf({"map", "info", "planned.yaml", "--json"});
  EXPECT_EQ(info["anchors"].get<std::size_t>(), plan["added"].size());
  EXPECT_EQ(bench_.pos({"map", "plan-anchors", "bare.yaml", "--across", "0.0001"}).exit_code, 4);
  const RunResult diff = bench_.pos({"map", "diff", "bare.yaml", "planned.yaml"});
  EXPECT_THAT(diff.out, HasSubstr("anchor 1 is new"));
  EXPECT_EQ(bench_.pos({"map", "diff", "bare.yaml", "bare.yaml"}).out, "no difference\n");
}

TEST_F(MapVerbs, IntervalsOfMapAndRoute) {
  const json route = jsonOf({"map", "intervals", site("interval_demo"), "--route", "into_branch", "--json"});
  ASSERT_GE(route.size(), 4U);
  EXPECT_EQ(route[2]["label"], "j_0");
  EXPECT_EQ(route[2]["from"], "i2");
  EXPECT_EQ(route[2]["to"], "j1");
  EXPECT_GT(jsonOf({"map", "intervals", site("interval_demo"), "--json"}).size(), route.size());
  const RunResult wrong = bench_.pos({"map", "intervals", site("interval_demo"), "--route", "into_brunch"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'into_branch'?"));
}

TEST_F(MapVerbs, CoverageWithoutRoadwaysIsNoResult) {
  for (const char* verb : {"coverage", "plan-anchors"}) {
    const RunResult run = bench_.pos({"map", verb, site("uwb_demo")});
    EXPECT_EQ(run.exit_code, 3) << verb;
    EXPECT_THAT(run.err, HasSubstr("no roadways"));
  }
}

TEST_F(MapVerbs, AMapWrittenElsewhereFindsItsGrid) {
  bench_.pos({"map", "plan-anchors", site("longwall"), "--out", "planned.yaml"});
  EXPECT_EQ(bench_.pos({"map", "info", "planned.yaml"}).exit_code, 0);
  EXPECT_EQ(bench_.pos({"map", "export", site("longwall"), "--out", "plan.geojson"}).exit_code, 0);
  EXPECT_EQ(bench_.pos({"map", "import", "plan.geojson", "--out", "back.yaml"}).exit_code, 0);
  EXPECT_EQ(bench_.pos({"map", "info", "back.yaml"}).exit_code, 0);
}

TEST_F(MapVerbs, OptionsWithoutUseAreRefused) {
  for (const std::vector<std::string>& extra : std::vector<std::vector<std::string>>{
           {"--level", "-60"}, {"--resolution-m", "1"}, {"--frame", "mine"}, {"--no-intervals"}}) {
    std::vector<std::string> arguments{"map", "export", site("shift_mine"), "--out", "plan.geojson"};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const RunResult run = bench_.pos(arguments);
    EXPECT_EQ(run.exit_code, 2) << extra[0];
    EXPECT_THAT(run.err, HasSubstr(extra[0]));
  }
  EXPECT_EQ(bench_.pos({"map", "import", "x.geojson", "--out", "x.yaml", "--join-m", "1"}).exit_code, 2);
  EXPECT_EQ(bench_.pos({"map", "import", "x.dxf", "--out", "x.yaml", "--data", "."}).exit_code, 2);
  EXPECT_EQ(bench_.pos({"map", "import", "x.dxf", "--out", "x.yaml", "--grid-name", "G"}).exit_code, 2);
}

TEST_F(MapVerbs, LockIntervalsAreDrawnWhereRoadwaysAreLocked) {
  bench_.pos({"map", "render", site("interval_demo"), "--out", "locked.svg"});
  bench_.pos({"map", "render", site("longwall"), "--out", "open.svg"});
  EXPECT_THAT(bench_.read("locked.svg"), HasSubstr(">lock intervals<"));
  EXPECT_THAT(bench_.read("open.svg"), ::testing::Not(HasSubstr("lock interval")));
}

TEST_F(MapVerbs, InitWritesAMapInOrder) {
  EXPECT_EQ(bench_.pos({"map", "init", "--out", "mine.yaml"}).exit_code, 0);
  const RunResult check = bench_.pos({"map", "check", "mine.yaml"});
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_EQ(check.out, "mine.yaml: in order\n");
}

}  // namespace pos::replay
