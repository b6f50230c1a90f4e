#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "complaint.hpp"
#include "pos/core/angle.hpp"
#include "pos/io/options.hpp"

namespace pos::io {
namespace {

using pos::test::complaintOf;
using testing::HasSubstr;

enum class Mode { Slow, Fast };

struct Range2 {
  double sigma = 0.1;
  double max = 100.0;
  bool operator==(const Range2&) const = default;
};

struct Item {
  std::string name;
  double heading = 0.5;
  bool operator==(const Item&) const = default;
};

struct Sample {
  double range_std = 0.25;
  double yaw = 0.1;
  double rate = 10.0;
  int count = 3;
  std::uint64_t seed = 1;
  Mode mode = Mode::Slow;
  bool use = true;
  std::string label = "a";
  std::filesystem::path file = "x.txt";
  std::optional<double> limit;
  std::optional<Range2> extra;
  Range2 range{0.2, 50.0};
  std::vector<Item> items;
  bool operator==(const Sample&) const = default;
};

OptionTable<Range2> rangeOptions() {
  return OptionTable<Range2>("range", "A range.")
      .number("sigma_m", &Range2::sigma, moreThan(0), "Its sigma.")
      .number("max_m", &Range2::max, between(0.5, 1000), "Its largest value.")
      .check([](const Range2& range) {
        if (range.sigma >= range.max)
          throw ConfigError(Complaint{.what = "sigma exceeds max", .key = "sigma_m"});
      });
}

OptionTable<Sample> sampleOptions() {
  return OptionTable<Sample>("Sample", "One of each.")
      .number("range_std_m", &Sample::range_std, between(0, 5), "A number with unit.")
      .number("yaw_deg", &Sample::yaw, between(-180, 180), "An angle.")
      .number("rate_hz", &Sample::rate, moreThan(0), "A rate.")
      .integer("count", &Sample::count, between(1, 100), "A whole number.")
      .integer("seed", &Sample::seed, atLeast(0), "A large whole number.")
      .choice("mode", &Sample::mode, {{"slow", Mode::Slow}, {"fast", Mode::Fast}}, "A choice.")
      .flag("use", &Sample::use, "A flag.")
      .text("label", &Sample::label, "A text.")
      .path("file", &Sample::file, "A path.")
      .number("limit_m", &Sample::limit, anything(), "An optional number.")
      .table("extra", &Sample::extra, rangeOptions(), "An optional table.")
      .table("range", &Sample::range, rangeOptions(), "A table.")
      .list("items", &Sample::items,
            OptionTable<Item>("items", "An item.")
                .text("name", &Item::name, "Its name.")
                .required()
                .number("heading_deg", &Item::heading, anything(), "Its heading."),
            "A list.");
}

Sample read(const std::string& text) {
  return readOptions(parseYaml(text, "c.yaml"), sampleOptions());
}
Complaint refusal(const std::string& text) {
  return complaintOf([&] { return read(text); });
}

TEST(OptionsRead, EmptyTableGivesTheDefaults) {
  EXPECT_EQ(read("{}"), Sample{});
}

TEST(OptionsRead, EveryKindOfValueArrives) {
  const Sample sample = read(
      "range_std_m: 1.5\nyaw_deg: 90\nrate_hz: 2e1\ncount: 7\nseed: 18446744073709551615\nmode: fast\nuse: "
      "false\n"
      "label: 'a b'\nfile: logs/x.rawlog\nlimit_m: -2\nextra: {sigma_m: 3}\nrange: {max_m: 60}\n"
      "items: [{name: one}, {name: two, heading_deg: 180}]\n");
  EXPECT_EQ(sample.range_std, 1.5);
  EXPECT_DOUBLE_EQ(sample.yaw, kPi / 2);
  EXPECT_EQ(sample.rate, 20.0);
  EXPECT_EQ(sample.count, 7);
  EXPECT_EQ(sample.seed, 18446744073709551615ULL);
  EXPECT_EQ(sample.mode, Mode::Fast);
  EXPECT_FALSE(sample.use);
  EXPECT_EQ(sample.label, "a b");
  EXPECT_EQ(sample.file, "logs/x.rawlog");
  EXPECT_EQ(sample.limit, -2.0);
  EXPECT_EQ(sample.extra, (Range2{3.0, 100.0}));
  EXPECT_EQ(sample.range, (Range2{0.2, 60.0})) << "the outer struct's default of sigma stays";
  EXPECT_EQ(sample.items, (std::vector<Item>{{"one", 0.5}, {"two", kPi}}));
}

TEST(OptionsRead, UnknownKeyIsRefusedWithTheNearestOne) {
  const Complaint complaint = refusal("count: 4\nrange_sdt_m: 1\n");
  EXPECT_EQ(complaint.what, "unknown key 'range_sdt_m'");
  EXPECT_EQ(toString(complaint.place), "c.yaml:2:1");
  EXPECT_EQ(complaint.key, "range_sdt_m");
  EXPECT_EQ(complaint.suggestion, "did you mean range_std_m?");
}

TEST(OptionsRead, UnknownKeyFarFromAllListsTheKnownOnes) {
  const Complaint complaint = refusal("zzzzzzzz: 4\n");
  EXPECT_THAT(complaint.expected, HasSubstr("one of: range_std_m, yaw_deg, rate_hz, count"));
  EXPECT_EQ(complaint.suggestion, "");
}

TEST(OptionsRead, WrongUnitIsNamed) {
  EXPECT_EQ(refusal("range_std_mm: 1\n").suggestion, "wrong unit: use range_std_m");
  EXPECT_EQ(refusal("yaw_rad: 1\n").suggestion, "wrong unit: use yaw_deg");
  EXPECT_EQ(refusal("rate_khz: 1\n").suggestion, "wrong unit: use rate_hz");
  EXPECT_EQ(refusal("range_std: 1\n").suggestion, "the unit belongs in the key: use range_std_m");
}

TEST(OptionsRead, KeyAtTheWrongLevelIsFoundOneLevelDown) {
  EXPECT_EQ(refusal("sigma_m: 1\n").suggestion, "did you mean extra.sigma_m?");
  EXPECT_EQ(refusal("heading_deg: 1\n").suggestion, "did you mean items[].heading_deg?");
}

TEST(OptionsRead, MissingRequiredKeyNamesItsTable) {
  const Complaint complaint = refusal("items:\n  - name: a\n  - heading_deg: 3\n");
  EXPECT_EQ(complaint.what, "the key 'name' is missing");
  EXPECT_EQ(toString(complaint.place), "c.yaml:3:5");
  EXPECT_EQ(complaint.key, "items[1].name");
  EXPECT_EQ(complaint.expected, "text, not empty");
}

TEST(OptionsRead, NumberWithUnitIsNotANumber) {
  const Complaint complaint = refusal("range_std_m: 1.5m\n");
  EXPECT_EQ(complaint.what, "this is not a number");
  EXPECT_EQ(toString(complaint.place), "c.yaml:1:14");
  EXPECT_EQ(complaint.got, "1.5m");
  EXPECT_EQ(complaint.expected, "a number in m, 0 to 5");
  EXPECT_EQ(complaint.suggestion, "the unit stands in the key; write 1.5");
}

struct BadText {
  std::string yaml;
  std::string what;
  std::string got;
  std::string suggestion;
};
class BadValue : public testing::TestWithParam<BadText> {};

TEST_P(BadValue, IsRefusedWithItsReason) {
  const Complaint complaint = refusal(GetParam().yaml + "\n");
  EXPECT_EQ(complaint.what, GetParam().what);
  EXPECT_EQ(complaint.got, GetParam().got);
  EXPECT_EQ(complaint.suggestion, GetParam().suggestion);
  EXPECT_EQ(complaint.place.line, 1);
  EXPECT_EQ(complaint.place.column, static_cast<int>(GetParam().yaml.find(": ")) + 3);
}

INSTANTIATE_TEST_SUITE_P(
    OptionsRead, BadValue,
    testing::Values(
        BadText{"range_std_m: 1,5", "this is not a number", "1,5", "write 1.5"},
        BadText{"range_std_m: 010", "this is not a number", "010", "a leading zero may mean octal; write 10"},
        BadText{"range_std_m: 0x10", "this is not a number", "0x10", ""},
        BadText{"range_std_m: 1_000", "this is not a number", "1_000", ""},
        BadText{"range_std_m: .", "this is not a number", ".", ""},
        BadText{"range_std_m: 1e", "this is not a number", "1e", "the unit stands in the key; write 1"},
        BadText{"range_std_m: .nan", "the number has to be finite", ".nan", ""},
        BadText{"range_std_m: nan", "the number has to be finite", "nan", ""},
        BadText{"range_std_m: -.inf", "the number has to be finite", "-.inf", ""},
        BadText{"range_std_m: 1e999", "the number is too large for the machine", "1e999", ""},
        BadText{"range_std_m: 5.001", "the value is too large", "5.001", ""},
        BadText{"range_std_m: -0.1", "the value is too small", "-0.1", ""},
        BadText{"rate_hz: 0", "the value is too small", "0", ""},
        BadText{"yaw_deg: 180.5", "the value is too large", "180.5", ""},
        BadText{"range_std_m: '0.3'", "this is text in quotes, not a number", "\"0.3\"", "remove the quotes"},
        BadText{"range_std_m: true", "this is not a number", "true", ""},
        BadText{"range_std_m: [1]", "this is not a number", "a list of 1", ""},
        BadText{"range_std_m: {a: 1}", "this is not a number", "a table of 1 key", ""},
        BadText{"range_std_m: ~", "this is not a number", "nothing", ""},
        BadText{"count: 1.7", "this is not a whole number", "1.7", "write it without a point or exponent"},
        BadText{"count: 1e1", "this is not a whole number", "1e1", "write it without a point or exponent"},
        BadText{"count: 010", "this is not a number", "010", "a leading zero may mean octal; write 10"},
        BadText{"count: 101", "the value is too large", "101", ""},
        BadText{"count: 0", "the value is too small", "0", ""},
        BadText{"count: 99999999999999999999", "the value is too large", "99999999999999999999", ""},
        BadText{"seed: -1", "the value is too small", "-1", ""},
        BadText{"seed: 18446744073709551616", "the value is too large", "18446744073709551616", ""},
        BadText{"mode: fats", "this is not one of the choices", "fats", "did you mean fast?"},
        BadText{"mode: [fast]", "this is not a word", "a list of 1", ""},
        BadText{"use: yes", "this is not true or false", "yes", "write true"},
        BadText{"use: 0", "this is not true or false", "0", "write false"},
        BadText{"label: ''", "the text is empty", "\"\"", ""},
        BadText{"label: null", "this is not text", "nothing", ""},
        BadText{"range: 3", "this is not a table", "3", "A range."},
        BadText{"items: {name: a}", "this is not a list", "a table of 1 key",
                "write `- ` before each item, or [] for none"}));

TEST(OptionsRead, RuleAcrossKeysIsReportedAtItsKey) {
  const Complaint complaint = refusal("label: x\nrange:\n  max_m: 2\n  sigma_m: 3\n");
  EXPECT_EQ(complaint.what, "sigma exceeds max");
  EXPECT_EQ(complaint.key, "range.sigma_m");
  EXPECT_EQ(toString(complaint.place), "c.yaml:4:3");
}

TEST(OptionsRead, RuleOverAnUnwrittenKeyIsReportedAtTheTable) {
  EXPECT_EQ(toString(refusal("range:\n  max_m: 0.5\n  sigma_m: 0.5\n").place), "c.yaml:3:3");
}

TEST(OptionsRead, WrittenTextReadsBackEqual) {
  Sample sample;
  sample.yaw = 1.0;
  sample.label = "it's: \"odd\" # [text]";
  sample.limit = 1.0 / 3.0;
  sample.extra = Range2{1e-12, 7.0};
  sample.seed = 18446744073709551615ULL;
  sample.items = {{"1", 0.1}, {"true", -3.0}, {"a\\b", 2.0 / 3.0}};
  EXPECT_EQ(read(optionsYaml(sample, sampleOptions())), sample);
  EXPECT_EQ(read(exampleYaml(sample, sampleOptions())), sample);
  EXPECT_EQ(read(optionsYaml(Sample{}, sampleOptions())), Sample{});
}

TEST(OptionsRead, KeyPathsAreTakenApart) {
  const auto steps = pathSteps("estimators[1].range.sigma_m");
  ASSERT_TRUE(steps);
  ASSERT_EQ(steps->size(), 4u);
  EXPECT_EQ((*steps)[0].name, "estimators");
  EXPECT_EQ((*steps)[1].index, 1u);
  EXPECT_EQ((*steps)[3].name, "sigma_m");
  for (const char* bad : {"", ".", "a.", ".a", "a..b", "a[", "a[]", "a[x]", "a[1", "a[1]b", "[1]", "a[-1]"}) {
    EXPECT_FALSE(pathSteps(bad)) << bad;
  }
}

}  // namespace
}  // namespace pos::io
