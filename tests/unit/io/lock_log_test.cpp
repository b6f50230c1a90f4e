#include "pos/io/lock_log.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "pos/core/error.hpp"
#include "pos/interval/lock_audit.hpp"
#include "pos/io/interval_csv.hpp"
#include "pos/io/locks_config.hpp"
#include "support/lock_mine.hpp"
#include "unit/io/scratch_folder.hpp"

namespace pos::io {
namespace {

std::string textOf(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

class LockLog : public ::testing::Test {
 protected:
  LockLog() : mine_(testing::lockMine()), scene_{*mine_.locks.site(), {}, mine_.ways()} {}

  /// Traffic written to `file`; returns its figures.
  traffic::TrafficResult written(const std::filesystem::path& file) const {
    LockLogWriter writer(file, scene_.ways);
    const traffic::TrafficWatch watch{
        .event = [&](const auto& event, const auto& records) { writer.write(event, records); }, .places = {}};
    const auto result =
        traffic::runTraffic(mine_.locks.site(), scene_.ways, {},
                            {.seed = 3, .vehicles = 8, .requests = 150, .restart_per_s = 1.0 / 800}, watch);
    writer.close();
    return result;
  }
  static interval::LockAudit audited(const std::filesystem::path& file, const LockScene& scene) {
    interval::LockAudit audit(std::make_shared<const interval::LockSite>(scene.site), scene.rules);
    LockLogReader reader(file, scene.ways);
    while (const auto step = reader.next()) audit.take(step->event, step->records);
    return audit;
  }

  ScratchFolder folder_;
  testing::LockMine mine_;
  LockScene scene_;
};

}  // namespace

TEST_F(LockLog, ReadsBackToWhatWasAudited) {
  const auto file = folder_.path() / "audit.csv";
  const traffic::TrafficResult result = written(file);
  ASSERT_GT(result.tally.restarts, 0u);
  const LockScene scene = lockSceneFrom(lockSceneJson(scene_), "scene.json");
  const interval::LockAudit again = audited(file, scene);
  EXPECT_EQ(again.tally().events, result.tally.events);
  EXPECT_EQ(again.tally().waits, result.tally.waits);
  EXPECT_EQ(again.tally().locks, result.tally.locks);
  EXPECT_EQ(again.tally().doubts, result.tally.doubts);
  EXPECT_EQ(again.tally().overrides, result.tally.overrides);
  EXPECT_EQ(again.findings().size(), 0u);
}

TEST_F(LockLog, AReleaseThatWasForgedIsFound) {
  const auto file = folder_.path() / "audit.csv";
  (void)written(file);
  std::string text = textOf(file);
  const std::size_t locked = text.find(",record,locked,");
  ASSERT_NE(locked, std::string::npos);
  const std::size_t end = text.find('\n', locked);
  const std::size_t begin = text.rfind('\n', locked) + 1;
  std::string forged = text.substr(begin, end - begin + 1);
  forged.replace(forged.find("locked"), 6, "released");
  text.insert(end + 1, forged);
  std::ofstream(file) << text;
  EXPECT_GT(audited(file, scene_).findings().size(), 0u);
}

TEST_F(LockLog, RowsThatMakeNoSenseAreRefusedWithTheirLine) {
  const auto refused = [&](const std::string& rows) {
    const auto file = folder_.path() / "bad.csv";
    std::ofstream(file) << "stamp_s,row,kind,vehicle,detail\n" << rows;
    try {
      (void)audited(file, scene_);
    } catch (const DataError& error) {
      return error.complaint().place.line;
    }
    return 0;
  };
  EXPECT_EQ(refused("0,event,tick,-1,\n1,event,dance,0,\n"), 3);
  EXPECT_EQ(refused("0,record,granted,0,stop=1\n"), 2);
  EXPECT_EQ(refused("0,event,report,0,distance_m=1\n"), 2);
  EXPECT_EQ(refused("0,event,report,0,distance_m=one;sigma_m=1\n"), 2);
  EXPECT_EQ(refused("0,event,begin,0,way=9999\n"), 2);
  EXPECT_EQ(refused("0,event,tick,-1,\n0,record,dances,0,\n"), 3);
}

TEST_F(LockLog, AnotherFileIsNoLogAndNoScene) {
  const auto file = folder_.path() / "other.csv";
  std::ofstream(file) << "a,b\n1,2\n";
  EXPECT_THROW(LockLogReader(file, {}), DataError);
  EXPECT_THROW(lockSceneFrom("{}", "scene.json"), DataError);
  EXPECT_THROW(lockSceneFrom("no json", "scene.json"), DataError);
}

TEST(LocksConfig, EitherTrafficOrVehicles) {
  const auto read = [](const std::string& more) {
    return readOptions(parseYaml("schema: 1\nname: n\nmap: m.yaml\n" + more, "locks.yaml"), locksOptions());
  };
  EXPECT_EQ(read("traffic: {vehicles: 5}\n").traffic->vehicles, 5);
  EXPECT_EQ(read("vehicles: [{file: a.tum, route: r}]\n").vehicles.front().route, "r");
  EXPECT_THROW(read(""), ConfigError);
  EXPECT_THROW(read("traffic: {}\nvehicles: [{file: a.tum, route: r}]\n"), ConfigError);
  EXPECT_THROW(read("traffic: {vehicels: 5}\n"), ConfigError);
  EXPECT_THROW(read("traffic: {}\nrules: {stale_after_s: 0}\n"), ConfigError);
}

TEST(IntervalsCsv, OneRowAnAnswerWithIdsAndProbabilities) {
  const testing::LockMine mine(testing::lockMine());
  const ScratchFolder folder;
  const auto file = folder.path() / "a.intervals.csv";
  IntervalsCsvWriter writer(file, mine.network.map(), mine.intervals);
  writer.write({.stamp = stampFromSeconds(1.0)});
  interval::IntervalBelief belief{.stamp = stampFromSeconds(2.0), .state = interval::MatchState::Decided};
  belief.point = {0, 12.5, -0.5, 0.0};
  belief.intervals = {{0, 0.75}, {1, 0.25}};
  belief.next = interval::BoundaryAhead{.interval = 1, .entry = true, .distance = 8.0, .seconds = 4.0};
  writer.write(belief);
  writer.close();
  CsvReader table(file);
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.cell(table.column("state")), "waiting");
  EXPECT_EQ(table.cell(table.column("intervals")), "");
  ASSERT_TRUE(table.next());
  EXPECT_EQ(table.cell(table.column("roadway")), "main");
  EXPECT_EQ(table.number(table.column("chainage_m")), 12.5);
  EXPECT_EQ(table.cell(table.column("intervals")),
            mine.intervals[0].id + "=0.7500 " + mine.intervals[1].id + "=0.2500");
  EXPECT_EQ(table.cell(table.column("next_is")), "entry");
  EXPECT_EQ(table.number(table.column("next_in_s")), 4.0);
}

}  // namespace pos::io
