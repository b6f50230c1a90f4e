// The editor's half on the server.
#include "pos/serve/map_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

namespace pos::serve {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

class Editor : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              ("pos_serve_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    fs::copy_file(fs::path(POS_SOURCE_DIR) / "maps/interval_demo/map.yaml", folder_ / "map.yaml");
    service_ = std::make_unique<MapService>(folder_ / "map.yaml", MapService::Access::Editable);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string text() const {
    std::ostringstream out;
    out << std::ifstream(folder_ / "map.yaml", std::ios::binary).rdbuf();
    return out.str();
  }
  /// The map with one anchor more.
  std::string edited(int id) const {
    json map = json::parse(service_->saved().geojson);
    map.at("features")
        .push_back({{"type", "Feature"},
                    {"geometry", {{"type", "Point"}, {"coordinates", {1.0, 1.0, 2.0}}}},
                    {"properties", {{"object", "anchor"}, {"id", id}, {"name", "new"}}}});
    return map.dump();
  }
  template <class Call>
  static int statusOf(Call call) {
    try {
      (void)call();
    } catch (const RequestError& error) {
      return error.status();
    }
    return 200;
  }

  fs::path folder_;
  std::unique_ptr<MapService> service_;
};

}  // namespace

TEST_F(Editor, SavesWhatWasEditedAndNothingElse) {
  const MapService::Version before = service_->saved();
  const std::string version = service_->save(edited(901), before.version);
  EXPECT_NE(version, before.version);
  EXPECT_EQ(service_->saved().version, version);
  EXPECT_THAT(text(), HasSubstr("901"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1)
      << "a draft was left";
  const json changes = json::parse(service_->diff(before.geojson)).at("changes");
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].at("kind"), "removed");
  EXPECT_EQ(changes[0].at("object"), "anchor 901");
}

TEST_F(Editor, ASecondEditorIsRefused) {
  const MapService::Version common = service_->saved();
  const std::string mine = edited(901);
  const std::string theirs = edited(902);
  (void)service_->save(mine, common.version);
  const std::string saved = text();
  EXPECT_EQ(statusOf([&] { return service_->save(theirs, common.version); }), 412);
  EXPECT_EQ(statusOf([&] { return service_->save(theirs, ""); }), 428);
  EXPECT_EQ(statusOf([&] { return service_->save(theirs, "*"); }), 412);
  EXPECT_EQ(text(), saved);
}

TEST_F(Editor, WhatIsNoMapLeavesTheFileAlone) {
  const std::string before = text();
  const std::string version = service_->saved().version;
  for (const std::string& body :
       {std::string(), std::string("{"), std::string("null"), std::string(100'000, '['),
        edited(901).substr(0, 900), std::string(R"({"type": "FeatureCollection", "features": []})")}) {
    EXPECT_EQ(statusOf([&] { return service_->save(body, version); }), 422);
    EXPECT_EQ(statusOf([&] { return service_->check(body); }), 422);
    EXPECT_EQ(statusOf([&] { return service_->diff(body); }), 422);
    EXPECT_EQ(statusOf([&] { return service_->coverage(body, {}); }), 422);
    EXPECT_EQ(statusOf([&] { return service_->intervals(body); }), 422);
  }
  EXPECT_EQ(text(), before);
}

TEST_F(Editor, WithoutTheNameOnTheCommandLineNothingIsWritten) {
  MapService reader(service_->file(), MapService::Access::ReadOnly);
  const std::string before = text();
  EXPECT_EQ(statusOf([&] { return reader.save(edited(901), reader.saved().version); }), 403);
  EXPECT_EQ(text(), before);
}

TEST_F(Editor, FindingsComeWithTheirPlace) {
  const json clean = json::parse(service_->check(service_->saved().geojson));
  const std::size_t before = clean.at("findings").size();
  const json now = json::parse(service_->check(edited(901)));  // an anchor in the rock
  EXPECT_GT(now.at("findings").size(), before);
  const json& finding = now.at("findings").at(0);
  EXPECT_TRUE(finding.at("place").at("x_m").is_number());
  EXPECT_FALSE(finding.at("what").get<std::string>().empty());
}

TEST_F(Editor, TheCoverageStripFollowsTheRoadway) {
  const std::string body = service_->saved().geojson;
  const json all = json::parse(service_->coverage(body, {})).at("roadways");
  const std::string id = all.at(0).at("roadway");
  const json one =
      json::parse(service_->coverage(body, {.query = {{"roadway", id}, {"step_m", "2"}}})).at("roadways");
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].at("chainage_m").size(), one[0].at("along_m").size());
  EXPECT_NEAR(static_cast<double>(one[0].at("chainage_m").size()),
              0.5 * static_cast<double>(all[0].at("chainage_m").size()), 1.0);
  EXPECT_EQ(statusOf([&] { return service_->coverage(body, {.query = {{"roadway", "none"}}}); }), 422);
  EXPECT_EQ(statusOf([&] { return service_->coverage(body, {.query = {{"step_m", "0"}}}); }), 400);
  EXPECT_EQ(statusOf([&] { return service_->coverage(body, {.query = {{"stepm", "1"}}}); }), 400);
}

TEST_F(Editor, IntervalsOfTheEditedMapAreDivided) {
  EXPECT_GT(json::parse(service_->intervals(service_->saved().geojson)).at("intervals").size(), 1U);
}

}  // namespace pos::serve
