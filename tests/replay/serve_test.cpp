// `pos serve` through its port: a run, a replay, a live feed, the map editor, and clients that misbehave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <cstring>
#include <iomanip>
#include <sstream>
#include <thread>

#include "replay/figures.hpp"
#include "replay/http.hpp"
#include "replay/running_pos.hpp"

namespace pos::replay {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kAddress = "http://127.0.0.1:";

/// Four ranges and a step of odometry, twenty times a second, on a line along x.
std::string feedLines(int from, int to) {
  std::ostringstream lines;
  lines << std::fixed << std::setprecision(9);
  for (int i = from; i < to; ++i) {
    const std::string stamp =
        std::to_string(1000 + i / 20) + "." + std::to_string(100 + 5 * (i % 20)).substr(1);
    const double x = 2.0 + 0.05 * i;
    lines << R"({"stamp_s": )" << stamp
          << R"(, "sensor": "wheels", "reading": "odometry", "x_m": 0.05, "interval_s": 0.05})"
          << "\n";
    for (int anchor = 1; anchor <= 4; ++anchor) {
      const double dx = (anchor % 2 == 0 ? 100.0 : 0.0) - x;
      const double dy = (anchor > 2 ? 10.0 : -10.0) - 0.3;
      lines << R"({"stamp_s": )" << stamp << R"(, "sensor": "uwb", "reading": "range", "anchor": )" << anchor
            << R"(, "range_m": )" << std::sqrt(dx * dx + dy * dy) << "}\n";
    }
  }
  return lines.str();
}

class Serve : public ::testing::Test {
 protected:
  void SetUp() override {
    bench_.write(
        "map.yaml",
        "schema: 2\nname: hall\nanchors:\n"
        "  - {id: 1, name: A, x_m: 0, y_m: -10, z_m: 0}\n  - {id: 2, name: B, x_m: 100, y_m: -10, z_m: 0}\n"
        "  - {id: 3, name: C, x_m: 0, y_m: 10, z_m: 0}\n  - {id: 4, name: D, x_m: 100, y_m: 10, z_m: 0}\n"
        "roadways:\n  - {id: R12, width_m: 21, height_m: 6, centreline: [{x_m: 0, y_m: 0, z_m: 0}, {x_m: "
        "100, "
        "y_m: 0, z_m: 0}]}\n");
    bench_.write(
        "run.yaml",
        "schema: 1\nname: hall\nmap: map.yaml\nrecord: {max_rate_hz: 50}\nintervals: {}\nestimators:\n"
        "  - {name: ekf, type: range_odometry, start: {mode: known, x_m: 2, y_m: 0.3, yaw_deg: 0}}\n"
        "  - {name: wheels, type: dead_reckoning, start: {mode: known, x_m: 2, y_m: 0.3, yaw_deg: 0}}\n");
  }

  std::vector<std::string> live() const {
    return {"serve", "--config", "run.yaml", "--live", "-", "--live-tcp",
            "0",     "--out",    "live",     "--port", "0"};
  }
  /// A recording of n twentieths of a second.
  void record(int n) const {
    Running server(bench_, live());
    (void)server.numberAfter(kAddress);
    server.feed(feedLines(0, n));
    server.closeInput();
    const int port = server.numberAfter(kAddress);
    while (!json::parse(get(port, "/api/state").body).at("ended").get<bool>()) usleep(10'000);
    server.signal(SIGTERM);
    ASSERT_EQ(server.wait(), 0) << server.err();
  }
  void makeRun(int n) const {
    record(n);
    const RunResult run =
        bench_.pos({"replay", "run.yaml", "--log", "live/log.rawlog", "--out", "run", "--quiet"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static json jsonOf(const HttpAnswer& answer) {
    EXPECT_EQ(answer.status, 200) << answer.body;
    return json::parse(answer.body);
  }
  static json command(int port, const std::string& body) {
    return jsonOf(send(port, "POST", "/api/command", body));
  }
  /// The state once `holds` is true of it.
  template <class Holds>
  static json stateWhen(int port, Holds holds) {
    json state;
    for (int i = 0; i < 2000; ++i) {
      state = jsonOf(get(port, "/api/state"));
      if (holds(state)) return state;
      usleep(10'000);
    }
    ADD_FAILURE() << "this state did not come: " << state.dump();
    return state;
  }
  /// Waits for an event of this kind.
  static void expectEvent(int port, const std::string& kind) {
    for (int i = 0; i < 2000; ++i) {
      for (const json& event : jsonOf(get(port, "/api/events")).at("events"))
        if (event.at("kind") == kind) return;
      usleep(10'000);
    }
    ADD_FAILURE() << "no event " << kind;
  }
  static std::string codeOf(const HttpAnswer& answer) {
    return json::parse(answer.body).at("error").at("code").get<std::string>();
  }

  Bench bench_;
};

std::vector<std::string> wholeLines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines.push_back(text.substr(begin, end - begin));
  return lines;
}

}  // namespace

TEST_F(Serve, AFinishedRunIsShownAndPlayed) {
  makeRun(400);
  Running server(bench_, {"serve", "--run", "run", "--port", "0"});
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

TEST_F(Serve, ALiveFeedIsShownAndItsSilenceNoticed) {
  std::vector<std::string> arguments = live();
  arguments.insert(arguments.end(), {"--stale-after", "0.4", "--lost-after", "1"});
  Running server(bench_, arguments);
  const int port = server.numberAfter(kAddress);
  const Sender sender(server.numberAfter("TCP 127.0.0.1:"));
  const auto uwb = [](const json& state) {
    for (const json& source : state.at("sources"))
      if (source.at("name") == "uwb") return source.at("state").get<std::string>();
    return std::string();
  };
  sender.send(feedLines(0, 100));
  EXPECT_EQ(uwb(stateWhen(port, [&](const json& s) { return uwb(s) == "connected"; })), "connected");
  (void)stateWhen(port, [&](const json& s) { return uwb(s) == "stale"; });
  (void)stateWhen(port, [&](const json& s) { return uwb(s) == "lost"; });
  expectEvent(port, "source_stale");
  expectEvent(port, "source_lost");
  sender.send(feedLines(100, 110));
  const json state = stateWhen(port, [&](const json& s) { return uwb(s) == "connected"; });
  EXPECT_TRUE(state.at("recording").at("on").get<bool>());
  expectEvent(port, "source_back");
  EXPECT_EQ(codeOf(send(port, "POST", "/api/command", R"({"do": "pause"})")), "not_in_this_mode");
}

TEST_F(Serve, BadLinesAreToldCountedAndSurvived) {
  Running server(bench_, live());
  const int port = server.numberAfter(kAddress);
  const int tcp = server.numberAfter("TCP 127.0.0.1:");
  const Sender nonsense(tcp);
  nonsense.send("hello\n{\"stamp_s\": 1}\n\xFF\xFE\n" + std::string(200, '[') + "\n" +
                R"({"stamp_s": 1000, "sensor": "uwb", "reading": "range", "anchor": 1, "range_m": -5})" +
                "\n");
  const Sender good(tcp);
  good.send(feedLines(0, 40));
  const json state = stateWhen(port, [](const json& s) {
    return s.at("refused_lines") == 5 && s.at("recording").at("measurements") == 200;
  });
  EXPECT_EQ(state.at("refused_lines"), 5);
  const json events = jsonOf(get(port, "/api/events")).at("events");
  int told = 0;
  for (const json& event : events) {
    if (event.at("kind") != "bad_line") continue;
    ++told;
    EXPECT_THAT(event.at("detail").get<std::string>(), StartsWith("line " + std::to_string(told)));
  }
  EXPECT_EQ(told, 5);
}

TEST_F(Serve, RecordingCanBeStoppedAndBegunAgain) {
  Running server(bench_, live());
  const int port = server.numberAfter(kAddress);
  const auto recorded = [](int n) {
    return [n](const json& s) { return s.at("recording").at("measurements") == n; };
  };
  server.feed(feedLines(0, 20));
  (void)stateWhen(port, recorded(100));
  EXPECT_FALSE(command(port, R"({"do": "record", "on": false})").at("recording").at("on").get<bool>());
  server.feed(feedLines(20, 40));
  (void)stateWhen(port, [](const json& s) { return s.at("stamp_s").get<double>() > 1001.9; });
  const json on = command(port, R"({"do": "record", "on": true})").at("recording");
  EXPECT_EQ(on.at("file"), "log-2.rawlog");
  server.feed(feedLines(40, 60));
  (void)stateWhen(port, recorded(100));
  server.signal(SIGTERM);
  EXPECT_EQ(server.wait(), 0) << server.err();
  for (const char* log : {"live/log.rawlog", "live/log-2.rawlog"}) {
    const RunResult run = bench_.pos({"replay", "run.yaml", "--log", log});
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
}

TEST_F(Serve, AKilledServersRecordingReplaysToTheSameEstimates) {
  Running server(bench_, live());
  const int port = server.numberAfter(kAddress);
  server.feed(feedLines(0, 600));
  (void)stateWhen(port, [](const json& s) { return s.at("recording").at("measurements") == 3000; });
  server.feed(feedLines(600, 601));
  usleep(1'000'000);  // what came a second ago has to be there
  server.feed(feedLines(601, 700));
  server.signal(SIGKILL);
  EXPECT_EQ(server.wait(), -1);
  const RunResult run =
      bench_.pos({"replay", "run.yaml", "--log", "live/log.rawlog", "--out", "again", "--quiet"});
  EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 5) << run.err;  // 5: cut inside an object
  for (const char* table : {"ekf.tum", "wheels.tum", "ekf.intervals.csv"}) {
    const std::vector<std::string> live_lines = wholeLines(bench_.read(std::string("live/") + table));
    const std::vector<std::string> again = wholeLines(bench_.read(std::string("again/") + table));
    const std::size_t common = std::min(live_lines.size(), again.size());
    EXPECT_GE(common, 600U) << table;
    EXPECT_TRUE(std::equal(live_lines.begin(), live_lines.begin() + static_cast<std::ptrdiff_t>(common),
                           again.begin()))
        << table;
  }
}

TEST_F(Serve, TheMapIsEditedAndAConflictRefused) {
  Running server(bench_, {"serve", "--map", "map.yaml", "--port", "0"});
  const int port = server.numberAfter(kAddress);
  EXPECT_TRUE(jsonOf(get(port, "/api/info")).at("map_editable").get<bool>());
  const HttpAnswer map = get(port, "/api/map");
  const std::string type = "Content-Type: application/geo+json\r\n";
  json edited = json::parse(map.body);
  for (json& feature : edited.at("features"))
    if (feature.at("properties").at("object") == "anchor" && feature.at("properties").at("id") == 1)
      feature.at("geometry").at("coordinates")[0] = 1.5;
  EXPECT_EQ(jsonOf(send(port, "POST", "/api/map/diff", edited.dump(), type)).at("changes").size(), 1U);
  EXPECT_TRUE(jsonOf(send(port, "POST", "/api/map/check", edited.dump(), type)).at("findings").is_array());
  EXPECT_EQ(jsonOf(send(port, "POST", "/api/map/coverage?roadway=R12", edited.dump(), type))
                .at("roadways")[0]
                .at("chainage_m")
                .size(),
            100U);
  const std::string match = "If-Match: " + map.headers.at("etag") + "\r\n";
  const HttpAnswer saved = send(port, "PUT", "/api/map", edited.dump(), type + match);
  EXPECT_EQ(jsonOf(saved).at("version"), saved.headers.at("etag"));
  EXPECT_THAT(bench_.read("map.yaml"), HasSubstr("x_m: 1.5"));
  const HttpAnswer conflict = send(port, "PUT", "/api/map", map.body, type + match);
  EXPECT_EQ(conflict.status, 412);
  EXPECT_EQ(codeOf(conflict), "conflict");
  EXPECT_THAT(bench_.read("map.yaml"), HasSubstr("x_m: 1.5"));
}

TEST_F(Serve, WhatNoClientShouldSendIsRefused) {
  Running server(bench_, {"serve", "--map", "map.yaml", "--port", "0"});
  const int port = server.numberAfter(kAddress);
  const auto status = [&](const std::string& bytes) {
    const std::string answer = exchanged(port, bytes);
    return answer.size() > 12 ? std::stoi(answer.substr(9, 3)) : 0;
  };
  const std::string host = "Host: localhost\r\nConnection: close\r\n";
  for (const char* path : {"/../map.yaml", "/%2e%2e/map.yaml", "/..%2fmap.yaml", "//map.yaml",
                           "/%5c..%5cmap.yaml", "/%00", "/assets/../../map.yaml"}) {
    EXPECT_EQ(status("GET " + std::string(path) + " HTTP/1.1\r\n" + host + "\r\n"), 400) << path;
  }
  EXPECT_EQ(status("GET /map.yaml HTTP/1.1\r\n" + host + "\r\n"), 404);
  EXPECT_EQ(status("GET /etc/passwd HTTP/1.1\r\n" + host + "\r\n"), 404);
  EXPECT_EQ(status("GET /api/info HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n"), 403);
  EXPECT_EQ(status("GET /api/info HTTP/1.1\r\n" + host + "Origin: http://evil.example\r\n\r\n"), 403);
  EXPECT_EQ(status("DELETE /api/map HTTP/1.1\r\n" + host + "\r\n"), 405);
  EXPECT_EQ(status("nonsense\r\n\r\n"), 400);
  EXPECT_EQ(status("GET " + std::string(20'000, 'a') + " HTTP/1.1\r\n" + host + "\r\n") / 100, 4);
  EXPECT_EQ(send(port, "POST", "/api/command", "{}").status, 400);
  EXPECT_EQ(send(port, "POST", "/api/command", "{}", "Content-Type: text/plain\r\n").status, 415);
  EXPECT_EQ(send(port, "POST", "/api/nothing", "{}").status, 404);
  EXPECT_EQ(send(port, "POST", "/api/map/check", "{}").status, 422);
  EXPECT_EQ(send(port, "PUT", "/api/map", "{}").status, 428);
  EXPECT_EQ(send(port, "POST", "/api/map/check", std::string((8U << 20) + 1, ' ')).status, 413);
  EXPECT_EQ(get(port, "/api/tracks/none").status, 404);
  EXPECT_EQ(get(port, "/api/events?limit=0").status, 400);
  EXPECT_EQ(get(port, "/api/info?x=1").status, 400);
  for (const std::string& path : {std::string("/api/nothing"), std::string("/api/events?limit=x")})
    EXPECT_FALSE(json::parse(get(port, path).body).at("error").at("what").get<std::string>().empty());
  EXPECT_EQ(get(port, "/api/info").status, 200) << "it still answers";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(bench_.folder()),
                          std::filesystem::directory_iterator()),
            4)
      << "something was written";  // map.yaml, run.yaml and the two outputs
}

TEST_F(Serve, AnotherAddressNeedsAToken) {
  Running server(bench_,
                 {"serve", "--map", "map.yaml", "--port", "0", "--address", "0.0.0.0", "--token", "secret"});
  const int port = server.numberAfter("http://0.0.0.0:");
  EXPECT_THAT(server.err(), HasSubstr("warning"));
  EXPECT_EQ(codeOf(get(port, "/api/info")), "unauthorised");
  EXPECT_EQ(get(port, "/api/info", "Authorization: Bearer secret\r\n").status, 200);
  const HttpAnswer page = get(port, "/?token=secret");
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.headers.at("set-cookie"), HasSubstr("pos_token=secret"));
  EXPECT_EQ(get(port, "/api/info", "Cookie: pos_token=secret\r\n").status, 200);
}

TEST_F(Serve, FiftyScreensAllHearEveryHeartbeat) {
  Running server(bench_, live());
  const int port = server.numberAfter(kAddress);
  std::vector<EventStream> screens;
  screens.reserve(50);
  for (int i = 0; i < 50; ++i) screens.emplace_back(port);
  server.feed(feedLines(0, 200));
  for (EventStream& screen : screens) EXPECT_FALSE(screen.next("state").empty());
  for (int beat = 0; beat < 3; ++beat) {
    std::string data;
    for (EventStream& screen : screens) {
      const std::string heard = screen.next("heartbeat");
      EXPECT_FALSE(heard.empty());
    }
  }
  EXPECT_EQ(get(port, "/api/info").status, 200);
  std::vector<EventStream> more;
  for (int i = 0; i < 11; ++i) more.emplace_back(port);
  EXPECT_EQ(codeOf(get(port, "/api/stream")), "too_many_streams");
}

TEST_F(Serve, ACommandLineThatMakesNoSenseIsRefused) {
  const auto refusal = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "serve");
    const RunResult run = bench_.pos(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    return run.err;
  };
  EXPECT_THAT(refusal({}), HasSubstr("nothing to show"));
  EXPECT_THAT(refusal({"--run", "a", "--config", "run.yaml"}), HasSubstr("cannot be shown together"));
  EXPECT_THAT(refusal({"--config", "run.yaml", "--live", "-"}), HasSubstr("--out"));
  EXPECT_THAT(refusal({"--live", "-", "--out", "x", "--map", "map.yaml"}), HasSubstr("--config"));
  const RunResult run = bench_.pos({"serve", "--run", "nowhere"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("run.json"));
}

}  // namespace pos::replay
