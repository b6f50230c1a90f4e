#include "pos/io/run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "pos/io/csv_table.hpp"
#include "pos/io/sha256.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(RunFolder, IsMadeWithItsParents) {
  const ScratchFolder folder;
  const RunFolder run = RunFolder::create(folder.path() / "a" / "b", ExistingRun::Refuse);
  EXPECT_TRUE(std::filesystem::is_directory(run.path()));
  EXPECT_EQ(run.tum("ekf"), run.path() / "ekf.tum");
  EXPECT_EQ(run.csv("ekf"), run.path() / "ekf.csv");
  EXPECT_EQ(run.runJson().filename(), "run.json");
  EXPECT_EQ(run.eventsCsv().filename(), "events.csv");
  EXPECT_EQ(run.summaryJson().filename(), "summary.json");
  EXPECT_EQ(run.reportHtml().filename(), "report.html");
}

TEST(RunFolder, EmptyOneIsTaken) {
  const ScratchFolder folder;
  EXPECT_NO_THROW(RunFolder::create(folder.path(), ExistingRun::Refuse));
}

TEST(RunFolder, NonEmptyOneIsRefusedAndSaysHow) {
  const ScratchFolder folder;
  folder.write("run.json", "old");
  const std::string what =
      complaintOf<ConfigError>([&] { RunFolder::create(folder.path(), ExistingRun::Refuse); });
  EXPECT_THAT(what, AllOf(HasSubstr("not empty"), HasSubstr("run.json"), HasSubstr("--force")));
  EXPECT_EQ(folder.read("run.json"), "old");
}

TEST(RunFolder, ReplaceRemovesTheEarlierRunAndNothingElse) {
  const ScratchFolder folder;
  for (const char* name : {"run.json", "summary.json", "events.csv", "report.html", "ekf.tum", "ekf.csv"}) {
    folder.write(name, "old");
  }
  folder.write("notes.txt", "mine");
  folder.write("survey.csv", "mine");
  RunFolder::create(folder.path(), ExistingRun::Replace);
  std::vector<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    left.push_back(entry.path().filename());
  }
  EXPECT_THAT(left, ::testing::UnorderedElementsAre("notes.txt", "survey.csv"));
}

TEST(RunFolder, AFileInItsPlaceIsRefused) {
  const ScratchFolder folder;
  const auto file = folder.write("x", "");
  for (const ExistingRun existing : {ExistingRun::Refuse, ExistingRun::Replace}) {
    EXPECT_THAT(complaintOf<ConfigError>([&] { RunFolder::create(file, existing); }), HasSubstr("is a file"));
    EXPECT_THROW(RunFolder::create(file / "below", existing), ConfigError);
  }
}

TEST(RunFolder, NamesThatLeaveTheFolderAreRefused) {
  const ScratchFolder folder;
  const RunFolder run = RunFolder::create(folder.path(), ExistingRun::Refuse);
  for (const char* name : {"", "..", "../x", "a/b", ".x", "a b", "events", "\xC3\xA4"}) {
    EXPECT_THROW(run.csv(name), ConfigError) << name;
    EXPECT_THROW(run.tum(name), ConfigError) << name;
  }
  EXPECT_NO_THROW(run.tum("range_odometry-2.1"));
}

TEST(RunFolder, EventsReadBack) {
  const ScratchFolder folder;
  EventsCsvWriter writer(folder.path() / "events.csv");
  writer.write({stampFromSeconds(1.5), "ekf", "gated", "uwb", "12 m, \"too\" long"});
  writer.write({.stamp = stampFromSeconds(2), .estimator = "ekf", .kind = "first_fix"});
  writer.close();
  CsvReader csv(folder.path() / "events.csv");
  EXPECT_EQ(text::joined(csv.columns()), "stamp_s, estimator, kind, sensor, detail");
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.cell(0), "1.500000000");
  EXPECT_EQ(csv.cell(4), "12 m, \"too\" long");
  ASSERT_TRUE(csv.next());
  EXPECT_EQ(csv.cell(3), "");
  EXPECT_FALSE(csv.next());
}

// Values of FIPS 180-4's examples.
TEST(Sha256, MatchesTheStandardsExamples) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  const ScratchFolder folder;
  const std::string bytes(200000, '\x7f');
  EXPECT_EQ(sha256OfFile(folder.write("x", bytes)), sha256(bytes));
  EXPECT_THROW(sha256OfFile(folder.path() / "no"), DataError);
}

}  // namespace
}  // namespace pos::io
