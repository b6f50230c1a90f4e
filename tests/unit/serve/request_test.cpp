// What a browser asks for, and who may ask.
#include "pos/serve/request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "pos/serve/command.hpp"
#include "support/mutations.hpp"

namespace pos::serve {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <class Call>
int statusOf(Call call) {
  try {
    (void)call();
  } catch (const RequestError& error) {
    return error.status();
  }
  return 200;
}

int statusOfTarget(std::string_view text) {
  return statusOf([&] { return parsedTarget(text); });
}

}  // namespace

TEST(Target, PathAndQueryAreDecoded) {
  const Target target = parsedTarget("/api/tracks/my%20ekf?from_s=1.5&columns=x_m%2Cy_m");
  EXPECT_THAT(target.path, ElementsAre("api", "tracks", "my ekf"));
  EXPECT_EQ(target.query.at("from_s"), "1.5");
  EXPECT_EQ(target.query.at("columns"), "x_m,y_m");
  EXPECT_EQ(target.pathText(), "/api/tracks/my ekf");
  EXPECT_TRUE(parsedTarget("/").path.empty());
  EXPECT_TRUE(parsedTarget("/?token=1").path.empty());
}

TEST(Target, WaysOutOfTheFolderAreRefused) {
  for (const char* path :
       {"/..", "/../etc/passwd", "/a/../b", "/%2e%2e/x", "/%2E%2E%2Fetc", "/a/%2fetc", "/a%5c..%5cb", "/./a",
        "//etc/passwd", "/a//b", "/a/", "/%00", "/a%0a", "etc", "", "*", "http://elsewhere/api"}) {
    EXPECT_EQ(statusOfTarget(path), 400) << path;
  }
}

TEST(Target, DamagedEscapesAndDoubleParametersAreRefused) {
  for (const char* path : {"/%", "/%4", "/%zz", "/a?b=%1", "/a?x=1&x=2"})
    EXPECT_EQ(statusOfTarget(path), 400) << path;
  EXPECT_EQ(statusOfTarget("/" + std::string(4095, 'a')), 200);
  EXPECT_EQ(statusOfTarget("/" + std::string(4096, 'a')), 400);
}

TEST(Target, ParametersAreCheckedByNameAndValue) {
  const Target target = parsedTarget("/a?n=5&t=1.5&bad=x&half=1.5&inf=inf");
  EXPECT_EQ(countOf(target, "n", 1, 10), 5U);
  EXPECT_EQ(countOf(target, "none", 1, 10), std::nullopt);
  EXPECT_EQ(statusOf([&] { return countOf(target, "n", 6, 10); }), 400);
  EXPECT_EQ(statusOf([&] { return countOf(target, "half", 1, 10); }), 400);
  EXPECT_EQ(statusOf([&] { return numberOf(target, "bad", 0, 1); }), 400);
  EXPECT_EQ(statusOf([&] { return numberOf(target, "inf", 0, 1e300); }), 400);
  EXPECT_EQ(stampOf(target, "t"), stampFromSeconds(1.5));
  EXPECT_EQ(statusOf([&] {
              requireOnly(target, {"n", "t", "bad", "half", "inf"});
              return 0;
            }),
            200);
  EXPECT_EQ(statusOf([&] {
              requireOnly(target, {"n", "t"});
              return 0;
            }),
            400);
}

TEST(Target, AnyBytesAreEitherATargetThatStaysInsideOrRefused) {
  const std::vector<std::string> samples{"/api/tracks/ekf?from_s=1&points=20", "/assets/index.js", "/api/map",
                                         "/api/events?after=3&limit=10"};
  const std::vector<std::string> pieces{"..", "/", "%2e", "%2F", "%5C", "%00", "?",
                                        "&",  "=", "%",   "+",   "//",  "/../"};
  RandomStream random(3, 1);
  int taken = 0;
  for (int i = 0; i < 100'000; ++i) {
    const std::string text =
        test::mutated(samples[static_cast<std::size_t>(i) % samples.size()], pieces, random);
    try {
      const Target target = parsedTarget(text);
      ++taken;
      for (const std::string& part : target.path) {
        ASSERT_FALSE(part.empty() || part == "." || part == "..") << text;
        ASSERT_EQ(part.find_first_of(std::string("/\\\0", 3)), std::string::npos) << text;
      }
    } catch (const RequestError& error) {
      ASSERT_EQ(error.status(), 400);
    }
  }
  EXPECT_GT(taken, 10'000);
  EXPECT_LT(taken, 90'000);
}

TEST(Guard, OnlyThisMachinesNamesAreAnsweredOnTheLoopback) {
  const auto status = [](const Asker& asker) {
    return statusOf([&] {
      requireAllowed({}, asker);
      return 0;
    });
  };
  for (const char* host : {"127.0.0.1", "127.0.0.1:8765", "localhost:1", "[::1]:8765", "localhost"})
    EXPECT_EQ(status({.host = host}), 200) << host;
  for (const char* host : {"", "mine.example", "127.0.0.1.evil.example", "localhost.evil:80", "192.168.0.2"})
    EXPECT_EQ(status({.host = host}), 403) << host;
  EXPECT_EQ(status({.host = "localhost:80", .origin = "http://localhost:80"}), 200);
  EXPECT_EQ(status({.host = "localhost:80", .origin = "http://localhost:81"}), 403);
  EXPECT_EQ(status({.host = "localhost:80", .origin = "http://evil.example"}), 403);
  EXPECT_EQ(status({.host = "localhost:80", .origin = "null"}), 403);
}

TEST(Guard, ElsewhereTheTokenIsAskedFor) {
  const Guard guard{.loopback = false, .token = "abc123"};
  const auto status = [&](const Asker& asker) {
    return statusOf([&] {
      requireAllowed(guard, asker);
      return 0;
    });
  };
  EXPECT_EQ(status({.host = "10.0.0.1"}), 401);
  EXPECT_EQ(status({.host = "10.0.0.1", .token = "abc124"}), 401);
  EXPECT_EQ(status({.host = "10.0.0.1", .token = "abc12"}), 401);
  EXPECT_EQ(status({.host = "10.0.0.1", .token = "abc123"}), 200);
  EXPECT_EQ(status({.authorization = "Bearer abc123"}), 200);
  EXPECT_EQ(status({.authorization = "abc123"}), 401);
  EXPECT_EQ(status({.cookie = "a=1; pos_token=abc123"}), 200);
  EXPECT_EQ(status({.cookie = "xpos_token=abc123"}), 401);
  EXPECT_EQ(status({.host = "10.0.0.1", .origin = "http://evil.example", .token = "abc123"}), 403);
}

TEST(ErrorJson, IsJsonWhateverTheRequestHeld) {
  const auto json = nlohmann::json::parse(
      errorJson(badRequest(Complaint{.what = "no", .key = "\xFF\xFE\"", .got = "\x01"})));
  EXPECT_EQ(json.at("error").at("status"), 400);
  EXPECT_EQ(json.at("error").at("code"), "bad_request");
  EXPECT_EQ(json.at("error").at("what"), "no");
}

TEST(Command, EachIsRead) {
  EXPECT_EQ(parsedCommand(R"({"do": "play"})").kind, Command::Kind::Play);
  EXPECT_EQ(parsedCommand(R"({"do": "pause"})").kind, Command::Kind::Pause);
  EXPECT_EQ(parsedCommand(R"({"do": "seek", "stamp_s": 12.5})").stamp, stampFromSeconds(12.5));
  EXPECT_EQ(parsedCommand(R"({"do": "speed", "speed": 4})").speed, 4.0);
  EXPECT_FALSE(parsedCommand(R"({"do": "record", "on": false})").on);
}

TEST(Command, EverythingElseIsRefused) {
  for (const char* body :
       {"", "{}", "[]", "null", "{\"do\": \"jump\"}", R"({"do": "play", "x": 1})", R"({"do": "seek"})",
        R"({"do": "seek", "stamp_s": 1e300})", R"({"do": "seek", "stamp_s": "1"})",
        R"({"do": "speed", "speed": 0})", R"({"do": "speed", "speed": -1})", R"({"do": "record", "on": 1})",
        R"({"do": "play"} x)", "{\"do\": \"\xFF\"}"}) {
    EXPECT_EQ(statusOf([&] { return parsedCommand(body); }), 400) << body;
  }
  EXPECT_EQ(statusOf([] { return parsedCommand(std::string(1U << 20, '[')); }), 400);
}

TEST(Command, AnyBytesAreACommandOrRefused) {
  const std::vector<std::string> samples{R"({"do":"seek","stamp_s":1.5})", R"({"do":"speed","speed":2})",
                                         R"({"do":"play"})"};
  const std::vector<std::string> pieces{"{", "}", "[", "\"", ":", ",", "1e9", "null", "\"do\":\"play\","};
  RandomStream random(3, 2);
  for (int i = 0; i < 100'000; ++i) {
    const std::string text =
        test::mutated(samples[static_cast<std::size_t>(i) % samples.size()], pieces, random);
    try {
      const Command command = parsedCommand(text);
      ASSERT_GE(command.speed, 0.1);
      ASSERT_LE(command.speed, 1000.0);
    } catch (const RequestError& error) {
      ASSERT_EQ(error.status(), 400);
    }
  }
}

TEST(Playhead, RunsWithTheClockAtItsSpeed) {
  const auto s = [](double t) { return durationFromSeconds(t); };
  Playhead head(stampFromSeconds(100));
  EXPECT_EQ(head.at(s(5)), stampFromSeconds(100));
  head.play(s(5));
  EXPECT_EQ(head.at(s(7)), stampFromSeconds(102));
  head.setSpeed(10, s(7));
  EXPECT_EQ(head.at(s(8)), stampFromSeconds(112));
  head.pause(s(8));
  EXPECT_EQ(head.at(s(20)), stampFromSeconds(112));
  head.seek(stampFromSeconds(50), s(20));
  EXPECT_EQ(head.at(s(21)), stampFromSeconds(50));
  head.play(s(21));
  head.seek(stampFromSeconds(60), s(22));
  EXPECT_EQ(head.at(s(22.5)), stampFromSeconds(65));
}

}  // namespace pos::serve
