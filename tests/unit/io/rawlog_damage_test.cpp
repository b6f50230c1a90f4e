/// Cut, flipped, empty and foreign files: everything before the damage is delivered, and the end says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"
#include "rawlog_samples.hpp"

namespace pos::io {
namespace {

std::string errorOf(const std::string& path) {
  try {
    RawlogReader reader(path);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

std::vector<Measurement> manyRanges(int count) {
  std::vector<Measurement> log;
  for (int i = 0; i < count; ++i) log.push_back({at(0.1 * i), "uwb", rangeTo(i % 7, 5.0 + 0.01 * i)});
  return log;
}

TEST(RawlogDamage, MissingEmptyTextAndFolderAreNamedWithARemedy) {
  const ScratchFolder folder;
  EXPECT_THAT(errorOf(folder.file("no.rawlog")), ::testing::HasSubstr("no such file"));
  replaceContent(folder.file("empty.rawlog"), "");
  EXPECT_THAT(errorOf(folder.file("empty.rawlog")), ::testing::HasSubstr("empty"));
  replaceContent(folder.file("text.rawlog"), "time,range\n1,2\n");
  const std::string text = errorOf(folder.file("text.rawlog"));
  EXPECT_THAT(text, ::testing::HasSubstr("no MRPT rawlog"));
  EXPECT_THAT(text, ::testing::HasSubstr("try:"));
  EXPECT_THAT(errorOf(folder.file("")), ::testing::HasSubstr("folder"));
}

TEST(RawlogDamage, AnEmptyGzipIsEmptyToo) {
  const ScratchFolder folder;
  writeLog(folder.file("e.rawlog"), {});
  EXPECT_THAT(errorOf(folder.file("e.rawlog")), ::testing::HasSubstr("empty"));
}

TEST(RawlogDamage, AFileCutAtHalfDeliversItsFirstHalf) {
  const ScratchFolder folder;
  for (const int level : {0, 1}) {
    const std::string path = folder.file("cut.rawlog");
    writeLog(path, manyRanges(3000), level);
    const std::string whole = contentOf(path);
    replaceContent(path, whole.substr(0, whole.size() / 2));
    const ReadLog log = readWhole(path);
    EXPECT_TRUE(log.end.damaged);
    EXPECT_FALSE(log.end.message.empty());
    EXPECT_EQ(log.end.objects, log.measurements.size());
    EXPECT_GT(log.measurements.size(), 1200U);
    EXPECT_LT(log.measurements.size(), 1800U);
    EXPECT_GT(log.end.byte, 100'000U);
  }
}

/// The uncompressed bytes of a log.
std::string plainBytes(const std::vector<Measurement>& measurements, const ScratchFolder& folder) {
  const std::string path = folder.file("source.rawlog");
  writeLog(path, measurements, 1);
  gzFile file = gzopen(path.c_str(), "rb");
  std::string bytes(1U << 22U, '\0');
  bytes.resize(static_cast<std::size_t>(std::max(0, gzread(file, bytes.data(), 1U << 22U))));
  gzclose(file);
  return bytes;
}

TEST(RawlogDamage, APlainFileCutInsideAnObjectTellsTheByteWhereTheLastWholeObjectEnds) {
  const ScratchFolder folder;
  const std::string bytes = plainBytes(manyRanges(10), folder);
  const std::size_t object = bytes.size() / 10;
  ASSERT_EQ(object * 10, bytes.size());
  replaceContent(folder.file("p.rawlog"), bytes.substr(0, 4 * object + 20));
  const ReadLog log = readWhole(folder.file("p.rawlog"));
  EXPECT_TRUE(log.end.damaged);
  EXPECT_EQ(log.measurements.size(), 4U);
  EXPECT_EQ(log.end.byte, 4 * object);
}

TEST(RawlogDamage, APlainFileCutBetweenObjectsCannotBeToldFromAShorterLog) {
  const ScratchFolder folder;
  const std::string bytes = plainBytes(manyRanges(10), folder);
  replaceContent(folder.file("p.rawlog"), bytes.substr(0, bytes.size() / 2));
  const ReadLog log = readWhole(folder.file("p.rawlog"));
  EXPECT_FALSE(log.end.damaged);
  EXPECT_EQ(log.measurements.size(), 5U);
}

TEST(RawlogDamage, AGzipCutBetweenObjectsIsStillDamaged) {
  const ScratchFolder folder;
  const std::string path = folder.file("g.rawlog");
  writeLog(path, manyRanges(10));
  const std::string whole = contentOf(path);
  replaceContent(path, whole.substr(0, whole.size() - 4));
  const ReadLog log = readWhole(path);
  EXPECT_EQ(log.measurements.size(), 10U);
  EXPECT_TRUE(log.end.damaged);
  EXPECT_THAT(log.end.message, ::testing::HasSubstr("cut short"));
}

TEST(RawlogDamage, FlippedBytesAreReportedAndACorruptClassNameIsPrintable) {
  const ScratchFolder folder;
  std::string bytes = plainBytes(manyRanges(10), folder);
  const std::size_t object = bytes.size() / 10;
  for (std::size_t i = 0; i < 6; ++i) bytes[5 * object + 12 + i] = static_cast<char>(0xF1 + i);
  replaceContent(folder.file("f.rawlog"), bytes);
  const ReadLog log = readWhole(folder.file("f.rawlog"));
  EXPECT_EQ(log.measurements.size(), 5U);
  ASSERT_TRUE(log.end.damaged);
  for (const char c : log.end.message) EXPECT_TRUE(c >= ' ' && c <= '~') << log.end.message;
}

TEST(RawlogDamage, FlippedBytesInAGzipAreReported) {
  const ScratchFolder folder;
  const std::string path = folder.file("z.rawlog");
  writeLog(path, manyRanges(30'000));
  std::string bytes = contentOf(path);
  for (std::size_t i = 0; i < 8; ++i) bytes[bytes.size() / 2 + i] ^= '\x5A';
  replaceContent(path, bytes);
  const ReadLog log = readWhole(path);
  EXPECT_TRUE(log.end.damaged);
  EXPECT_GT(log.measurements.size(), 1000U);
}

/// Two ranges; the second object claims to hold `count` of them, and `first` stands where its first one
/// begins.
std::string withACountOf(const std::string& count, const std::string& first, const ScratchFolder& folder) {
  std::string bytes = plainBytes(manyRanges(2), folder);
  const std::size_t second = bytes.size() / 2;
  const std::size_t place = bytes.find("CObservationBeaconRanges", second) + 24 + 1 + 12;
  EXPECT_EQ(bytes.substr(place, 4), std::string("\x01\0\0\0", 4));
  return bytes.replace(place, 4 + first.size(), count + first);
}

TEST(RawlogDamage, AnAbsurdCountOfRangesIsRefusedBeforeAnythingIsBuilt) {
  const ScratchFolder folder;
  const std::string four_billion("\xFF\xFF\xFF\xFF");
  const std::string sixteen_million("\xFF\xFF\xFF\0", 4);
  const std::string unknown_object(
      "\x83"
      "CAt",
      4);
  for (const std::string& bytes :
       {withACountOf(four_billion, "", folder), withACountOf(sixteen_million, unknown_object, folder)}) {
    replaceContent(folder.file("c.rawlog"), bytes);
    const ReadLog log = readWhole(folder.file("c.rawlog"));
    EXPECT_EQ(log.measurements.size(), 1U);
    EXPECT_TRUE(log.end.damaged);
    EXPECT_THAT(log.end.message, ::testing::HasSubstr("absurd number of parts"));
  }
}

/// Random cuts and flips never crash or hang the reader, and what it delivers is never defective.
class RawlogMutation : public ::testing::TestWithParam<int> {};

TEST_P(RawlogMutation, EndsCleanOrDamaged) {
  const ScratchFolder folder;
  const int level = GetParam();
  const std::string path = folder.file("m.rawlog");
  writeLog(path, oneOfEachKind(), 1);
  const std::string whole = level == 0 ? plainBytes(oneOfEachKind(), folder) : contentOf(path);
  int damaged = 0;
  int refused = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomStream random(7, static_cast<std::uint64_t>(trial));
    std::string bytes = whole;
    const auto place = [&] {
      return static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size()));
    };
    if (random.bernoulli(0.2)) bytes.resize(place());
    const int flips = 1 + static_cast<int>(6.0 * random.uniform());
    for (int i = 0; i < flips && !bytes.empty(); ++i)
      bytes[place()] = static_cast<char>(random.bits() & 0xFFU);
    replaceContent(path, bytes);
    try {
      const ReadLog log = readWhole(path);
      damaged += log.end.damaged ? 1 : 0;
      for (const Measurement& measurement : log.measurements) ASSERT_FALSE(defect(measurement));
    } catch (const DataError&) {
      ++refused;
    }
  }
  EXPECT_GT(damaged + refused, kTrials / 4);
  EXPECT_LT(refused, kTrials);
}

INSTANTIATE_TEST_SUITE_P(PlainAndGzip, RawlogMutation, ::testing::Values(0, 1));

}  // namespace
}  // namespace pos::io
