#pragma once
/// A hall with four anchors, estimators for it, and `pos serve` before them.

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "replay/figures.hpp"
#include "replay/http.hpp"
#include "replay/running_pos.hpp"

namespace pos::replay {

inline constexpr const char* kAddress = "http://127.0.0.1:";

/// JSON lines: four ranges and a step of odometry, twenty times a second, on a line along x.
std::string feedLines(int from, int to);

class Serve : public ::testing::Test {
 protected:
  void SetUp() override {
    bench_.write(
        "map.yaml",
        "schema: 2\nname: hall\nanchors:\n"
        "  - {id: 1, name: A, x_m: 0, y_m: -10, z_m: 0}\n  - {id: 2, name: B, x_m: 100, y_m: -10, z_m: 0}\n"
        "  - {id: 3, name: C, x_m: 0, y_m: 10, z_m: 0}\n  - {id: 4, name: D, x_m: 100, y_m: 10, z_m: 0}\n"
        "roadways:\n  - {id: R12, width_m: 21, height_m: 6, centreline: [{x_m: 0, y_m: 0, z_m: 0}, {x_m: "
        "100, y_m: 0, z_m: 0}]}\n"
        "chambers:\n  - {id: c1, roadway: R12, chainage_m: 50, side: right, length_m: 8, depth_m: 3, "
        "capacity: 1}\n"
        "routes:\n  - {id: through, legs: [{roadway: R12, from_m: 0, to_m: 100}]}\n");
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
      const json told = jsonOf(get(port, "/api/events"));
      for (const json& event : told.at("events"))
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

}  // namespace pos::replay
