#include "pos/io/csv_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pos/core/random.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Reads all cells of all rows.
std::vector<std::vector<std::string>> rowsOf(const std::string& text) {
  CsvReader csv(text, "t.csv");
  std::vector<std::vector<std::string>> rows;
  while (csv.next()) {
    rows.emplace_back();
    for (std::size_t i = 0; i < csv.columns().size(); ++i) rows.back().emplace_back(csv.cell(i));
  }
  return rows;
}

TEST(CsvTable, ReadsPlainRows) {
  EXPECT_THAT(rowsOf("a,b\n1,2\n3,4\n"), ElementsAre(ElementsAre("1", "2"), ElementsAre("3", "4")));
}

TEST(CsvTable, TakesCrlfByteOrderMarkCommentsAndEmptyLines) {
  EXPECT_THAT(rowsOf("\xEF\xBB\xBF# about\r\n\r\na,b\r\n1,2\r\n  \r\n# more\r\n3,4"),
              ElementsAre(ElementsAre("1", "2"), ElementsAre("3", "4")));
}

TEST(CsvTable, KeepsEmptyCellsAlsoTheLast) {
  EXPECT_THAT(rowsOf("a,b,c\n,,\n1,,\n"), ElementsAre(ElementsAre("", "", ""), ElementsAre("1", "", "")));
}

TEST(CsvTable, TakesBlanksOffCellsButNotOffQuotedOnes) {
  EXPECT_THAT(rowsOf("a , b\n 1\t,  \" x \" \n"), ElementsAre(ElementsAre("1", " x ")));
}

TEST(CsvTable, ReadsQuotesWithCommasAndQuotesInside) {
  EXPECT_THAT(rowsOf("a,b,c\n\"x,y\",\"he said \"\"no\"\"\",\"\"\n"),
              ElementsAre(ElementsAre("x,y", "he said \"no\"", "")));
}

TEST(CsvTable, WhatCsvCellWritesReadsBack) {
  for (const std::string cell : {"plain", "a,b", "say \"hi\"", " ends ", "#x", ""}) {
    EXPECT_THAT(rowsOf("a,b\n1," + text::csvCell(cell) + "\n"), ElementsAre(ElementsAre("1", cell)));
  }
  EXPECT_EQ(text::csvCell("two\nlines"), "two lines");
}

TEST(CsvTable, RowOfWrongLengthNamesLineAndBothLengths) {
  const std::string what = complaintOf<DataError>([] { rowsOf("a,b\n1,2\n1,2,3\n"); });
  EXPECT_THAT(what, AllOf(HasSubstr("t.csv:3:1"), HasSubstr("3 cells"), HasSubstr("2 cells: a, b")));
}

TEST(CsvTable, BadNumberNamesLineColumnAndName) {
  CsvReader csv("t_s,range_m\n0.5, 1.5m\n", "t.csv");
  ASSERT_TRUE(csv.next());
  EXPECT_DOUBLE_EQ(csv.number(0), 0.5);
  const std::string what = complaintOf<DataError>([&] { csv.number(1); });
  EXPECT_THAT(what, AllOf(HasSubstr("t.csv:2:6"), HasSubstr("range_m"), HasSubstr("'1.5m'")));
}

TEST(CsvTable, OnlyFiniteNumbersWithAPointAreNumbers) {
  for (const char* good : {"1", "-1.5", "+2", "1e-3", ".5", "5."}) EXPECT_TRUE(text::number(good)) << good;
  for (const char* bad : {"", "nan", "inf", "-inf", "1e999", "1,5", "0x10", "1 2", "--1", "+-1", "+", "."}) {
    EXPECT_FALSE(text::number(bad)) << bad;
  }
}

TEST(CsvTable, WholeNumbersMayBeWrittenAsReals) {
  EXPECT_EQ(text::integer("7"), 7);
  EXPECT_EQ(text::integer("-7.0"), -7);
  EXPECT_EQ(text::integer("9223372036854775807"), INT64_MAX);
  for (const char* bad : {"7.5", "", "x", "1e300", "nan"}) EXPECT_FALSE(text::integer(bad)) << bad;
}

TEST(CsvTable, TimesAreExactToTheNanosecond) {
  using text::TimeUnit;
  EXPECT_EQ(text::duration("1600000000.123456789")->count(), 1600000000123456789);
  EXPECT_EQ(text::duration("-0.0000000016")->count(), -2);
  EXPECT_EQ(text::duration("12.5", TimeUnit::Milliseconds)->count(), 12500000);
  EXPECT_EQ(text::duration("1.5", TimeUnit::Microseconds)->count(), 1500);
  EXPECT_EQ(text::duration("1403636579758555392", TimeUnit::Nanoseconds)->count(), 1403636579758555392);
  EXPECT_EQ(text::duration("1.6e9")->count(), 1600000000000000000);
  for (const char* bad : {"", "1e10", "9999999999", "nan", "t"}) EXPECT_FALSE(text::duration(bad)) << bad;
}

TEST(CsvTable, StampsReadBackExactly) {
  for (const std::int64_t ns : {0L, 1L, -1L, 999999999L, -1500000000L, 1600000000123456789L}) {
    const Stamp stamp{Duration{ns}};
    EXPECT_EQ(Stamp{*text::duration(text::stampSeconds(stamp))}, stamp);
  }
  EXPECT_EQ(text::stampSeconds(Stamp{Duration{-1500000000}}), "-1.500000000");
}

TEST(CsvTable, ZeroIsWrittenWithoutSign) {
  EXPECT_EQ(text::fixed(-1e-12, 3), "0.000");
  EXPECT_EQ(text::shortest(-0.0), "0");
  EXPECT_EQ(text::fixed(-0.001, 3), "-0.001");
}

TEST(CsvTable, BadHeadersAreRefused) {
  EXPECT_THAT(complaintOf<DataError>([] { rowsOf(""); }), HasSubstr("empty"));
  EXPECT_THAT(complaintOf<DataError>([] { rowsOf("a,,b\n"); }), HasSubstr("t.csv:1:3: a column has no name"));
  EXPECT_THAT(complaintOf<DataError>([] { rowsOf("a,b,a\n"); }), HasSubstr("two columns have the same name"));
}

TEST(CsvTable, BadQuotesAreRefused) {
  EXPECT_THAT(complaintOf<DataError>([] { rowsOf("a,b\n1,\"x\n"); }),
              HasSubstr("t.csv:2:3: a quote is not closed"));
  EXPECT_THAT(complaintOf<DataError>([] { rowsOf("a,b\n\"x\"y,1\n"); }),
              HasSubstr("text after a closing quote"));
  EXPECT_THAT(complaintOf<DataError>([] { rowsOf("a,b\nx\"y,1\n"); }), HasSubstr("a quote inside a cell"));
}

TEST(CsvTable, MissingColumnListsColumnsAndSuggestsOne) {
  const CsvReader csv("t_s,range_m,anchor_id\n", "t.csv");
  const std::string what = complaintOf<DataError>([&] { csv.column("rang_m"); });
  EXPECT_THAT(what, AllOf(HasSubstr("t_s, range_m, anchor_id"), HasSubstr("did you mean 'range_m'?")));
}

TEST(CsvTable, MissingFileAndFolderAreRefused) {
  const ScratchFolder folder;
  EXPECT_THAT(complaintOf<DataError>([&] { CsvReader csv(folder.path() / "no.csv"); }), HasSubstr("no.csv"));
  EXPECT_THAT(complaintOf<DataError>([&] { CsvReader csv(folder.path()); }), HasSubstr("cannot open"));
}

TEST(CsvTable, MutatedTextLoadsOrThrowsAnError) {
  const std::string good = "t_s,tag,\"range, m\"\r\n0.5,1,2.25\n# c\n0.75,\"2\",\"1.5\"\n";
  const std::string alphabet = std::string(",\"\n\r#. -e9x\t\xEF") + '\0';
  RandomStream random(7, 0);
  int loaded = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = good;
    for (unsigned edits = 1 + random.bits() % 4; edits > 0; --edits) {
      const std::size_t at = random.bits() % text.size();
      const char c = alphabet[random.bits() % alphabet.size()];
      if (random.bernoulli(0.3)) {
        text.erase(at, 1 + random.bits() % 3);
      } else if (random.bernoulli(0.5)) {
        text.insert(at, 1, c);
      } else {
        text[at] = c;
      }
      if (text.empty()) break;
    }
    try {
      CsvReader csv(text, "t.csv");
      while (csv.next()) {
        for (std::size_t c = 0; c < csv.columns().size(); ++c) csv.number(c);
      }
      ++loaded;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("t.csv"));
    }
  }
  EXPECT_GT(loaded, 1000);  // the fuzz reaches both ends
  EXPECT_LT(loaded, 15000);
}

}  // namespace
}  // namespace pos::io
