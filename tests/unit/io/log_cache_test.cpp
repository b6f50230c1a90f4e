/// Packed copies of logs: the same measurements to the last bit, tied to their source, damage told.
#include "pos/io/log_cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "pos/io/json_lines.hpp"
#include "rawlog_samples.hpp"

namespace pos::io {
namespace {

using ::testing::HasSubstr;

struct Read {
  std::vector<Measurement> measurements;
  LogEnd end;
  LogTally tally;
};

Read readAll(LogReader& reader) {
  Read all;
  while (auto measurement = reader.next()) all.measurements.push_back(std::move(*measurement));
  all.end = reader.end();
  all.tally = reader.tally();
  return all;
}

/// Every bit but for a rotation's, which the text tells by three angles; those are compared beside it.
void expectSame(const std::vector<Measurement>& a, const std::vector<Measurement>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(jsonLine(a[i]), jsonLine(b[i]));
    EXPECT_EQ(a[i].reading.index(), b[i].reading.index());
    if (const auto* scan = std::get_if<Scan2D>(&a[i].reading)) {
      EXPECT_EQ(scan->T_body_sensor.rotation.coeffs(),
                std::get<Scan2D>(b[i].reading).T_body_sensor.rotation.coeffs());
    }
    if (const auto* truth = std::get_if<PoseTruth>(&a[i].reading)) {
      EXPECT_EQ(truth->T_map_body.rotation.coeffs(),
                std::get<PoseTruth>(b[i].reading).T_map_body.rotation.coeffs());
    }
  }
}

std::string logOfEachKind(const ScratchFolder& folder) {
  writeLog(folder.file("a.rawlog"), oneOfEachKind());
  return folder.file("a.rawlog");
}

TEST(LogCache, DeliversWhatTheLogDeliversBitByBit) {
  const ScratchFolder folder;
  const std::string log = logOfEachKind(folder);
  const CopiedLog packed = packLog(log, folder.file("a.cache"));
  RawlogReader source(log);
  LogCacheReader copy(folder.file("a.cache"));
  const Read expected = readAll(source);
  const Read got = readAll(copy);
  expectSame(got.measurements, expected.measurements);
  EXPECT_EQ(packed.measurements, expected.measurements.size());
  EXPECT_EQ(got.end.objects, expected.end.objects);
  EXPECT_EQ(got.end.byte, expected.end.byte);
  EXPECT_FALSE(got.end.damaged);
  EXPECT_EQ(got.tally.skipped, expected.tally.skipped);
  EXPECT_EQ(got.tally.refused, expected.tally.refused);
  EXPECT_EQ(got.tally.references, expected.tally.references);
}

TEST(LogCache, SpansManyBlocks) {
  const ScratchFolder folder;
  std::vector<Measurement> many;
  for (int i = 0; i < 20'000; ++i)
    many.push_back({at(0.01 * i), i % 3 == 0 ? "a" : "b", rangeTo(i % 9, 1.0 + i)});
  writeLog(folder.file("a.rawlog"), many);
  packLog(folder.file("a.rawlog"), folder.file("a.cache"));
  LogCacheReader copy(folder.file("a.cache"));
  RawlogReader source(folder.file("a.rawlog"));
  expectSame(readAll(copy).measurements, readAll(source).measurements);
}

TEST(LogCache, ADamagedLogsCopySaysSo) {
  const ScratchFolder folder;
  const std::string log = logOfEachKind(folder);
  const std::string bytes = contentOf(log);
  replaceContent(log, bytes.substr(0, bytes.size() / 2));
  EXPECT_TRUE(packLog(log, folder.file("a.cache")).end.damaged);
  LogCacheReader copy(folder.file("a.cache"));
  RawlogReader source(log);
  const Read expected = readAll(source);
  const Read got = readAll(copy);
  expectSame(got.measurements, expected.measurements);
  EXPECT_TRUE(got.end.damaged);
  EXPECT_EQ(got.end.message, expected.end.message);
}

TEST(LogCache, IsReadInPlaceOfItsLogAndOnlyOfItsLog) {
  const ScratchFolder folder;
  const std::string log = folder.file("a.rawlog");
  writeLog(log, {{at(0.0), "uwb", rangeTo(1, 2.0)}}, 0);
  EXPECT_TRUE(openLog(log).note.empty());
  packLog(log, cacheBeside(log));
  const OpenedLog opened = openLog(log);
  EXPECT_NE(dynamic_cast<LogCacheReader*>(opened.reader.get()), nullptr);
  EXPECT_THAT(opened.note, HasSubstr("packed copy"));

  // Written again with the same content: the checksum tells.
  std::filesystem::last_write_time(log, std::filesystem::last_write_time(log) + std::chrono::hours(1));
  EXPECT_NE(dynamic_cast<LogCacheReader*>(openLog(log).reader.get()), nullptr);

  // Another range, the size kept.
  const auto size = std::filesystem::file_size(log);
  writeLog(log, {{at(0.0), "uwb", rangeTo(1, 3.0)}}, 0);
  ASSERT_EQ(std::filesystem::file_size(log), size);
  const OpenedLog changed = openLog(log);
  EXPECT_NE(dynamic_cast<RawlogReader*>(changed.reader.get()), nullptr);
  EXPECT_THAT(changed.note, HasSubstr("has changed"));
}

TEST(LogCache, ACopyOfAnotherVersionIsLeftAlone) {
  const ScratchFolder folder;
  const std::string log = logOfEachKind(folder);
  packLog(log, cacheBeside(log));
  std::string bytes = contentOf(cacheBeside(log));
  bytes[6] = 9;
  replaceContent(cacheBeside(log), bytes);
  const OpenedLog opened = openLog(log);
  EXPECT_NE(dynamic_cast<RawlogReader*>(opened.reader.get()), nullptr);
  EXPECT_THAT(opened.note, HasSubstr("no packed copy that can be read"));
}

TEST(LogCache, ACopyOfACopyIsRefusedAndNoHalfFileIsLeft) {
  const ScratchFolder folder;
  packLog(logOfEachKind(folder), folder.file("a.cache"));
  EXPECT_THROW(packLog(folder.file("a.cache"), folder.file("b.cache")), DataError);
  EXPECT_THROW(packLog(folder.file("none.rawlog"), folder.file("b.cache")), DataError);
  EXPECT_FALSE(std::filesystem::exists(folder.file("b.cache")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("b.cache.part")));
}

TEST(LogCache, EveryCutAndEveryFlippedByteIsFound) {
  const ScratchFolder folder;
  packLog(logOfEachKind(folder), folder.file("a.cache"));
  const std::string whole = contentOf(folder.file("a.cache"));
  const auto refused = [&](const std::string& bytes) {
    replaceContent(folder.file("b.cache"), bytes);
    try {
      LogCacheReader reader(folder.file("b.cache"));
      while (reader.next()) continue;
    } catch (const DataError&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused(whole));
  for (std::size_t size = 0; size < whole.size(); size += 7)
    EXPECT_TRUE(refused(whole.substr(0, size))) << size;
  for (std::size_t i = 0; i < whole.size(); i += 3) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x20);
    EXPECT_TRUE(refused(bytes)) << i;
  }
  EXPECT_TRUE(refused(whole + "x"));
}

}  // namespace
}  // namespace pos::io
