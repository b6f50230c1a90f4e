// `pos serve` through its port: a finished run and a replay in progress.
#include <gmock/gmock.h>

#include <cstring>

#include "replay/serve_bench.hpp"

namespace pos::replay {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

}  // namespace

TEST_F(Serve, AFinishedRunIsShownAndPlayed) {
  makeRun(400);
  Running server(bench_, {"serve", "--run", "run", "--route", "through", "--port", "0"});
  const int port = server.numberAfter(kAddress);
  const json info = jsonOf(get(port, "/api/info"));
  EXPECT_EQ(info.at("mode"), "run");
  EXPECT_EQ(info.at("estimators").size(), 2U);
  EXPECT_FALSE(info.at("map_editable").get<bool>());
  EXPECT_TRUE(info.at("report").get<bool>());
  EXPECT_NEAR(info.at("last_s").get<double>() - info.at("first_s").get<double>(), 19.95, 0.1);

  const json at = jsonOf(get(port, "/api/state?at_s=1010.02"));
  EXPECT_NEAR(at.at("estimators")[0].at("pose").at("x_m").get<double>(), 12.0, 0.5);
  EXPECT_THAT(at.at("estimators")[0].at("place").at("words").get<std::string>(), StartsWith("R12, "));
  EXPECT_EQ(at.at("estimators")[0].at("place").at("lock"), "held");
  EXPECT_EQ(at.at("locks")[1].at("state"), "held") << "by the rules it may drive on to the end";

  const HttpAnswer track = get(port, "/api/tracks/ekf?points=50&columns=x_m,y_m");
  ASSERT_EQ(track.status, 200);
  EXPECT_EQ(track.headers.at("x-pos-columns"), "x_m,y_m");
  std::uint32_t rows = 0;
  std::memcpy(&rows, track.body.data() + 8, 4);
  EXPECT_GT(rows, 10U);
  EXPECT_LE(rows, 50U);
  EXPECT_EQ(track.body.size(), 24 + rows * 16U);

  EXPECT_EQ(json::parse(get(port, "/api/map").body).at("type"), "FeatureCollection");
  EXPECT_EQ(jsonOf(get(port, "/api/summary")).at("run").at("name"), "hall");
  EXPECT_THAT(get(port, "/api/report").body, HasSubstr("<html"));
  EXPECT_GT(jsonOf(get(port, "/api/events")).at("total").get<int>(), 0);
  EXPECT_FALSE(jsonOf(get(port, "/api/intervals")).at("intervals").empty());
  EXPECT_THAT(get(port, "/").body, HasSubstr("<html"));

  EventStream stream(port);
  EXPECT_FALSE(stream.next("state").empty());
  (void)command(port, R"({"do": "speed", "speed": 20})");
  EXPECT_TRUE(command(port, R"({"do": "play"})").at("playing").get<bool>());
  EXPECT_FALSE(stream.next("state").empty());
  EXPECT_FALSE(stream.next("heartbeat").empty());
  const json end = stateWhen(port, [](const json& state) { return state.at("ended").get<bool>(); });
  EXPECT_FALSE(end.at("playing").get<bool>());
  EXPECT_NEAR(end.at("estimators")[0].at("pose").at("x_m").get<double>(), 22.0, 0.5);
  EXPECT_NEAR(command(port, R"({"do": "seek", "stamp_s": 1005})").at("stamp_s").get<double>(), 1005.0, 1e-6);
  EXPECT_EQ(codeOf(send(port, "POST", "/api/command", R"({"do": "record", "on": true})")),
            "not_in_this_mode");
  server.signal(SIGINT);
  EXPECT_EQ(server.wait(), 0) << server.err();
}

TEST_F(Serve, AReplayCanBePlayedSoughtAndHurried) {
  record(400);
  Running server(bench_, {"serve", "--config", "run.yaml", "--log", "live/log.rawlog", "--port", "0"});
  const int port = server.numberAfter(kAddress);
  EXPECT_EQ(jsonOf(get(port, "/api/info")).at("mode"), "replay");
  EXPECT_NEAR(jsonOf(get(port, "/api/info")).at("last_s").get<double>(), 1019.95, 0.01);
  EXPECT_FALSE(jsonOf(get(port, "/api/state")).at("playing").get<bool>());
  EventStream stream(port);

  (void)command(port, R"({"do": "seek", "stamp_s": 1015})");
  const json there = stateWhen(port, [](const json& s) { return !s.at("seeking").get<bool>(); });
  EXPECT_NEAR(there.at("stamp_s").get<double>(), 1015.0, 0.01);
  EXPECT_NEAR(there.at("estimators")[0].at("pose").at("x_m").get<double>(), 17.0, 0.3);
  EXPECT_EQ(there.at("sources").size(), 2U);
  EXPECT_EQ(there.at("anchors").size(), 4U);
  EXPECT_EQ(there.at("anchors")[0].at("seen"), "seen");
  EXPECT_EQ(there.at("locks")[0].at("state"), "held");
  EXPECT_EQ(there.at("locks")[1].at("state"), "free") << "by its place it is not there";
  EXPECT_NEAR(there.at("sources")[0].at("period_s").get<double>(), 0.05, 0.001);

  (void)command(port, R"({"do": "seek", "stamp_s": 1002})");
  EXPECT_FALSE(stream.next("reset").empty());
  const json back = stateWhen(port, [](const json& s) { return !s.at("seeking").get<bool>(); });
  EXPECT_NEAR(back.at("estimators")[0].at("pose").at("x_m").get<double>(), 4.0, 0.3);
  const json tracks = jsonOf(get(port, "/api/tracks")).at("tracks");
  EXPECT_NEAR(tracks[0].at("last_s").get<double>(), 1002.0, 0.2) << "the future is not shown";

  (void)command(port, R"({"do": "speed", "speed": 50})");
  (void)command(port, R"({"do": "play"})");
  const json end = stateWhen(
      port, [](const json& s) { return s.at("ended").get<bool>() && !s.at("playing").get<bool>(); });
  EXPECT_NEAR(end.at("estimators")[0].at("pose").at("x_m").get<double>(), 22.0, 0.3);
  EXPECT_EQ(codeOf(get(port, "/api/state?at_s=1001")), "not_in_this_mode");
  EXPECT_EQ(codeOf(get(port, "/api/summary")), "not_there");
}

TEST_F(Serve, AReplayShowsWhatPosReplayComputes) {
  makeRun(200);
  Running server(bench_, {"serve", "--config", "run.yaml", "--log", "live/log.rawlog", "--port", "0"});
  const int replay = server.numberAfter(kAddress);
  (void)command(replay, R"({"do": "seek", "stamp_s": 2000})");
  (void)stateWhen(replay,
                  [](const json& s) { return s.at("ended").get<bool>() && !s.at("seeking").get<bool>(); });
  Running other(bench_, {"serve", "--run", "run", "--port", "0"});
  const int run = other.numberAfter(kAddress);
  for (const char* track : {"ekf", "wheels"}) {
    const std::string path =
        std::string("/api/tracks/") + track + "?columns=x_m,y_m,yaw_rad,gated,chainage_m";
    const std::string a = get(replay, path).body;
    const std::string b = get(run, path).body;
    ASSERT_EQ(a.size(), b.size());
    ASSERT_GT(a.size(), 24U);
    EXPECT_EQ(a.substr(0, 24), b.substr(0, 24));
  }
}

}  // namespace pos::replay
