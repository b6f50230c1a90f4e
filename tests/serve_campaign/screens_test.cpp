// Fifty screens on one server for a minute.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <vector>

#include "replay/http.hpp"
#include "replay/running_pos.hpp"

namespace pos::replay {

TEST(Screens, FiftyHearEveryHeartbeatOfAMinuteAndTheMemoryStaysFlat) {
  const Bench bench;
  const Running server(bench, {"serve", "--config", source("configs/uwb_demo/unknown_heading.yaml").string(),
                               "--play", "--port", "0"});
  const int port = server.numberAfter("http://127.0.0.1:");
  std::vector<EventStream> screens;
  screens.reserve(50);
  for (int i = 0; i < 50; ++i) screens.emplace_back(port);
  std::vector<int> beats(screens.size(), 0);
  std::vector<int> states(screens.size(), 0);
  std::size_t after_ten = 0;
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  while (Clock::now() - begin < std::chrono::seconds(60)) {
    for (std::size_t i = 0; i < screens.size(); ++i) {
      const EventStream::Arrived arrived = screens[i].arrived();
      beats[i] += arrived.heartbeats;
      states[i] += arrived.states;
    }
    if (after_ten == 0 && Clock::now() - begin > std::chrono::seconds(10)) after_ten = server.memory();
    usleep(100'000);
  }
  const std::size_t at_end = server.memory();
  for (std::size_t i = 0; i < screens.size(); ++i) {
    EXPECT_GE(beats[i], 58) << "screen " << i;
    EXPECT_LE(beats[i], 61) << "screen " << i;
    EXPECT_GE(states[i], 300) << "screen " << i;
    EXPECT_LE(states[i], 1220) << "screen " << i << ": more than twenty a second";
  }
  EXPECT_LT(at_end, after_ten + (16U << 20)) << "the track of a minute takes 0.1 MiB";
  RecordProperty("heartbeats", beats.front());
  RecordProperty("states", states.front());
  RecordProperty("memory_after_10_s", static_cast<int>(after_ten >> 10));
  RecordProperty("memory_after_60_s", static_cast<int>(at_end >> 10));
  std::printf("screen 0: %d heartbeats, %d states; memory %zu KiB after 10 s, %zu KiB after 60 s\n",
              beats.front(), states.front(), after_ten >> 10, at_end >> 10);
}

}  // namespace pos::replay
