// Live measurements as lines of JSON.
#include "pos/io/json_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "rawlog_samples.hpp"
#include "support/mutations.hpp"

namespace pos::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Complaint refusalOf(const std::string& line, int number = 7) {
  try {
    (void)measurementFrom(line, "feed", number);
  } catch (const DataError& error) {
    return error.complaint();
  }
  ADD_FAILURE() << "taken: " << line;
  return {};
}

}  // namespace

TEST(JsonLines, EveryReadingComesBackToTheLastBit) {
  for (const Measurement& measurement : oneOfEachKind()) {
    const std::string line = jsonLine(measurement);
    const Measurement read = measurementFrom(line, "feed");
    EXPECT_EQ(read.stamp, measurement.stamp) << line;
    EXPECT_EQ(read.reading.index(), measurement.reading.index()) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
    if (std::holds_alternative<Scan2D>(read.reading)) continue;  // angles of the sensor are turned round
    EXPECT_EQ(jsonLine(read), line);
  }
}

TEST(JsonLines, ARangeIsReadAsItIsWritten) {
  const Measurement m = measurementFrom(
      R"({"stamp_s": 1700000000.123456789, "sensor": "uwb", "reading": "range", "anchor": 12, "range_m": 7.5})",
      "feed");
  EXPECT_EQ(m.stamp.time_since_epoch().count(), 1'700'000'000'123'456'789LL);
  EXPECT_EQ(m.sensor, "uwb");
  const auto& range = std::get<BeaconRange>(m.reading);
  EXPECT_EQ(range.anchor, 12);
  EXPECT_EQ(range.range, 7.5);
  EXPECT_FALSE(range.sigma);
}

TEST(JsonLines, AnglesComeInDegrees) {
  const Measurement m = measurementFrom(
      R"({"stamp_s": 1, "sensor": "gyro", "reading": "wheel_speeds", "left_m_per_s": 1, "right_m_per_s": 1, "yaw_rate_deg_per_s": 180})",
      "feed");
  EXPECT_DOUBLE_EQ(*std::get<WheelSpeeds>(m.reading).yaw_rate, kPi);
}

TEST(JsonLines, ABadLineIsRefusedWithLineAndKey) {
  const std::string good = R"("stamp_s": 1, "sensor": "u", "reading": "range", "anchor": 1)";
  EXPECT_EQ(refusalOf("{" + good + ", \"range_m\": -1}").key, "range_m");
  EXPECT_EQ(refusalOf("{" + good + ", \"range_m\": -1}").place.line, 7);
  EXPECT_THAT(refusalOf("{" + good + ", \"range_m\": 1, \"rnage_m\": 1}").key, HasSubstr("rnage_m"));
  EXPECT_THAT(refusalOf("{" + good + "}").what, HasSubstr("missing"));
  EXPECT_THAT(refusalOf("{" + good + ", \"range_m\": \"1\"}").got, HasSubstr("1"));
  EXPECT_EQ(refusalOf(R"({"sensor": "u"})").key, "stamp_s");
  EXPECT_EQ(refusalOf(R"({"stamp_s": "1"})").key, "stamp_s");
  EXPECT_EQ(refusalOf(R"({"stamp_s": 1e300})").key, "stamp_s");
  EXPECT_THAT(refusalOf("[1]").what, HasSubstr("no JSON object"));
  EXPECT_FALSE(refusalOf("{").what.empty());
  EXPECT_FALSE(refusalOf("nonsense").what.empty());
  EXPECT_FALSE(refusalOf("{\"stamp_s\": NaN}").what.empty());
  EXPECT_FALSE(refusalOf(R"({"stamp_s": 1, "sensor": "i", "reading": "imu", "rates_deg_per_s": [1, 2, 3]})")
                   .what.empty());
  EXPECT_FALSE(
      refusalOf(
          R"({"stamp_s":1,"sensor":"g","reading":"gnss","latitude_deg":1,"longitude_deg":1,"altitude_m":1,"covariance":[1]})")
          .what.empty());
}

TEST(JsonLines, AnyTextIsEitherAMeasurementWithoutDefectOrRefused) {
  std::vector<std::string> samples;
  for (const Measurement& measurement : oneOfEachKind()) samples.push_back(jsonLine(measurement));
  const std::vector<std::string> pieces{"{",    "}",       "[",
                                        "]",    ":",       ",",
                                        "\"",   "null",    "1e999",
                                        "-",    "\\u0000", "\"stamp_s\":1,",
                                        "true", "\xFF",    "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["};
  RandomStream random(9, 1);
  int taken = 0;
  int refused = 0;
  for (int i = 0; i < 100'000; ++i) {
    const std::string line =
        test::mutated(samples[static_cast<std::size_t>(i) % samples.size()], pieces, random);
    try {
      const Measurement measurement = measurementFrom(line, "feed");
      ASSERT_FALSE(defect(measurement)) << line;
      ++taken;
    } catch (const DataError&) {
      ++refused;
    }
  }
  EXPECT_GT(taken, 1000);
  EXPECT_GT(refused, 10'000);
  RecordProperty("taken", taken);
  RecordProperty("refused", refused);
}

TEST(LineCutter, LinesDoNotDependOnHowTheBytesArrive) {
  const std::string text = "one\r\n\n  \ntwo\nthree";
  for (std::size_t step = 1; step <= text.size(); ++step) {
    LineCutter cutter;
    std::vector<std::string> lines;
    std::vector<int> numbers;
    const auto take = [&](const LineCutter::Line& line) {
      lines.push_back(line.text);
      numbers.push_back(line.number);
    };
    for (std::size_t i = 0; i < text.size(); i += step)
      cutter.feed(std::string_view(text).substr(i, step), take);
    cutter.finish(take);
    EXPECT_THAT(lines, ElementsAre("one", "two", "three"));
    EXPECT_THAT(numbers, ElementsAre(1, 4, 5));
  }
}

TEST(LineCutter, ALineWithoutEndDoesNotFillTheMemory) {
  LineCutter cutter;
  std::vector<LineCutter::Line> lines;
  const auto take = [&](const LineCutter::Line& line) { lines.push_back(line); };
  const std::string block(1U << 16, 'x');
  for (int i = 0; i < 64; ++i) cutter.feed(block, take);
  cutter.feed("\nshort\n", take);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_TRUE(lines[0].too_long);
  EXPECT_TRUE(lines[0].text.empty());
  EXPECT_EQ(lines[1].text, "short");
  EXPECT_EQ(lines[1].number, 2);
}

TEST(JsonLines, TheSensorOfABadLineIsKnownWhereItIsNamed) {
  EXPECT_EQ(sensorNamedBy(R"({"sensor": "uwb", "x": 1})"), "uwb");
  EXPECT_EQ(sensorNamedBy(R"({"sensor": 1})"), "");
  EXPECT_EQ(sensorNamedBy("{\"sensor\": \"uwb\""), "");
}

}  // namespace pos::io
