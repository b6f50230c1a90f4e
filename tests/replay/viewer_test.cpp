// viewer.html: a finished run in one page, filled by `pos replay` and `pos report`.
#include <gmock/gmock.h>

#include "replay/serve_bench.hpp"

namespace pos::replay {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// An interface whose page only shows where the run goes.
class Viewer : public Serve {
 protected:
  void SetUp() override {
    Serve::SetUp();
    record(200);
    std::filesystem::create_directories(bench_.folder() / "page");
    bench_.write("page/index.html", "<html></html>");
    bench_.write("page/viewer.html", "<script>POS_RUN_JSON</script>");
  }
  RunResult replay(const std::string& out, const std::string& interface) const {
    return bench_.pos({"replay", "run.yaml", "--log", "live/log.rawlog", "--out", out, "--interface",
                       interface, "--quiet"});
  }
  json runInside() const {
    const std::string page = bench_.read("out/viewer.html");
    EXPECT_THAT(page, StartsWith("<script>{"));
    const std::string inner = page.substr(8, page.rfind("</script>") - 8);
    EXPECT_EQ(inner.find('<'), std::string::npos) << "an element in the data would end the script";
    return json::parse(inner);
  }
};

TEST_F(Viewer, AReplaysFolderHoldsAPageWithTheRunInsideWhichPosReportMakesAgain) {
  const RunResult made = replay("out", "page");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const json run = runInside();
  EXPECT_EQ(run.at("format"), "pos.viewer/1");
  EXPECT_EQ(run.at("info").at("name"), "hall");
  EXPECT_EQ(run.at("info").at("mode"), "run");
  EXPECT_EQ(run.at("map").at("type"), "FeatureCollection");
  EXPECT_EQ(run.at("intervals").size(), 2U);
  EXPECT_EQ(run.at("locks").at(0).at("states"), (json{"held", "free"}));
  EXPECT_EQ(run.at("events").at(0).at("kind"), "interval_entry");
  ASSERT_EQ(run.at("tracks").size(), 2U);
  EXPECT_EQ(run.at("tracks").at(0).at("name"), "ekf");
  EXPECT_EQ(run.at("tracks").at(0).at("columns").at(0), "x_m");
  EXPECT_THAT(run.at("tracks").at(0).at("base64"), StartsWith("UE9TVFJLMD"));  // POSTRK0
  EXPECT_TRUE(run.at("background").is_null());
  EXPECT_THAT(bench_.read("out/report.html"), HasSubstr("href=\"viewer.html\""));

  const std::string page = bench_.read("out/viewer.html");
  bench_.write("out/viewer.html", "old");
  const RunResult again = bench_.pos({"report", "out", "--interface", "page", "--quiet"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(bench_.read("out/viewer.html"), page);
  EXPECT_THAT(bench_.read("out/report.html"), HasSubstr("href=\"viewer.html\""));

  const RunResult none = replay("none", "run");
  EXPECT_EQ(none.exit_code, 3) << none.err;
  EXPECT_THAT(none.err, HasSubstr("--interface"));
  bench_.write("page/viewer.html", "<html>no place</html>");
  const RunResult other = replay("other", "page");
  EXPECT_EQ(other.exit_code, 5) << other.err;
  EXPECT_THAT(other.err, HasSubstr("POS_RUN_JSON"));
}

}  // namespace
}  // namespace pos::replay
