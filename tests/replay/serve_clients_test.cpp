// `pos serve` through its port: the map editor, clients that misbehave, and who may ask.
#include <gmock/gmock.h>

#include <filesystem>

#include "replay/serve_bench.hpp"

namespace pos::replay {
namespace {

using ::testing::HasSubstr;

}  // namespace

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
  EXPECT_THAT(refusal({"--map", "map.yaml", "--route", "through"}), HasSubstr("--route"));
  const RunResult run = bench_.pos({"serve", "--run", "nowhere"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("run.json"));
}

}  // namespace pos::replay
