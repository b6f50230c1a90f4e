// Rawlogs that are written while they are used.
#include "pos/io/rawlog_tape.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "pos/io/append_file.hpp"
#include "pos/io/json_lines.hpp"
#include "rawlog_samples.hpp"

namespace pos::io {
namespace {

std::vector<std::string> linesOf(const std::vector<Measurement>& measurements) {
  std::vector<std::string> lines;
  for (const Measurement& measurement : measurements) lines.push_back(jsonLine(measurement));
  return lines;
}

struct Told {
  std::vector<Measurement> measurements;
  std::string bytes;
  std::vector<std::size_t> ends;  // bytes after each call
};

Told tapedSamples() {
  RawlogTape tape;
  Told told;
  for (const Measurement& measurement : oneOfEachKind()) {
    Taped taped = tape.take(measurement);
    told.bytes += taped.bytes;
    told.ends.push_back(told.bytes.size());
    for (Measurement& read : taped.read_back) told.measurements.push_back(std::move(read));
  }
  return told;
}

}  // namespace

TEST(RawlogTape, TheFileGivesBackWhatWasTold) {
  const ScratchFolder folder;
  const Told told = tapedSamples();
  replaceContent(folder.file("log.rawlog"), told.bytes);
  const ReadLog log = readWhole(folder.file("log.rawlog"));
  EXPECT_FALSE(log.end.damaged);
  EXPECT_EQ(linesOf(log.measurements), linesOf(told.measurements));
  EXPECT_EQ(told.measurements.size(), oneOfEachKind().size());
}

TEST(RawlogTape, TheFileIsTheOneThatTheWriterMakes) {
  const ScratchFolder folder;
  writeLog(folder.file("log.rawlog"), oneOfEachKind(), 0);
  EXPECT_EQ(linesOf(readWhole(folder.file("log.rawlog")).measurements), linesOf(tapedSamples().measurements));
}

TEST(RawlogTape, AFileCutAfterAnyCallGivesWhatWasToldUpToThere) {
  const ScratchFolder folder;
  const Told told = tapedSamples();
  const std::vector<std::string> all = linesOf(told.measurements);
  for (std::size_t i = 0; i < told.ends.size(); ++i) {
    replaceContent(folder.file("cut.rawlog"), told.bytes.substr(0, told.ends[i]));
    const std::vector<std::string> read = linesOf(readWhole(folder.file("cut.rawlog")).measurements);
    EXPECT_EQ(read, std::vector<std::string>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(i + 1)));
  }
}

TEST(RawlogTape, StampsOfTheFutureAreTaken) {
  RawlogTape tape;
  const Stamp later = stampFromSeconds(4e9);
  const Taped taped = tape.take({later, "uwb", rangeTo(1, 2.0)});
  ASSERT_EQ(taped.read_back.size(), 1U);
  EXPECT_EQ(taped.read_back.front().stamp, later);
}

TEST(RawlogTape, ADefectiveMeasurementLeavesTheTapeAsItWas) {
  RawlogTape tape;
  EXPECT_THROW((void)tape.take({at(1.0), "uwb", rangeTo(1, -2.0)}), DataError);
  EXPECT_EQ(tape.take({at(1.0), "uwb", rangeTo(1, 2.0)}).read_back.size(), 1U);
}

TEST(AppendFile, WhatWasFlushedIsInTheFile) {
  const ScratchFolder folder;
  AppendFile file(folder.file("a.bin"));
  file.append("one");
  EXPECT_EQ(contentOf(folder.file("a.bin")), "");
  EXPECT_EQ(file.bytes(), 3U);
  file.flush();
  EXPECT_EQ(contentOf(folder.file("a.bin")), "one");
  file.append("two");
  file.close();
  EXPECT_EQ(contentOf(folder.file("a.bin")), "onetwo");
}

TEST(AppendFile, AnExistingFileIsNotTouched) {
  const ScratchFolder folder;
  replaceContent(folder.file("a.bin"), "mine");
  EXPECT_THROW(AppendFile(folder.file("a.bin")), DataError);
  EXPECT_THROW(AppendFile(folder.file("missing/a.bin")), DataError);
  EXPECT_EQ(contentOf(folder.file("a.bin")), "mine");
}

}  // namespace pos::io
