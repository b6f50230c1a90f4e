// `pos serve` through its port: a live feed, what goes wrong with one, and its recording.
#include <gmock/gmock.h>

#include <algorithm>

#include "replay/serve_bench.hpp"

namespace pos::replay {
namespace {

using ::testing::StartsWith;

std::vector<std::string> wholeLines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines.push_back(text.substr(begin, end - begin));
  return lines;
}

}  // namespace

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

}  // namespace pos::replay
