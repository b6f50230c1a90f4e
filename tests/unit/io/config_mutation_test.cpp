#include <gtest/gtest.h>

#include "config_text.hpp"
#include "pos/core/random.hpp"
#include "pos/io/map_yaml.hpp"
#include "pos/io/overrides.hpp"
#include "pos/io/run_config.hpp"

namespace pos::io {
namespace {

std::size_t below(RandomStream& random, std::size_t limit) {
  return static_cast<std::size_t>(random.uniform() * static_cast<double>(limit));
}

/// One small edit: a byte changed, a piece removed, doubled or moved, or a word of YAML put in.
std::string edited(std::string text, RandomStream& random) {
  static const std::vector<std::string> kWords = {"\n",    "  ",
                                                  ": ",    "- ",
                                                  "[",     "]",
                                                  "{",     "}",
                                                  "'",     "\"",
                                                  "#",     "&a ",
                                                  "*a",    "!x ",
                                                  "---\n", "? ",
                                                  "|\n",   ">-\n",
                                                  "~",     "<<: ",
                                                  "%",     "@",
                                                  "1e999", "-0",
                                                  "\t",    "\\x41",
                                                  ",",     "nan",
                                                  "...\n", "99999999999999999999",
                                                  "\xc3",  "\xe2\x80\xa8",
                                                  "\x04"};
  const std::size_t at = below(random, text.size() + 1);
  const std::size_t length = std::min(below(random, 30), text.size() - at);
  const std::string piece = text.substr(at, length);
  switch (below(random, 5)) {
    case 0:
      return text.insert(
          at, 1, static_cast<char>(random.bernoulli(0.9) ? 32 + below(random, 95) : below(random, 256)));
    case 1:
      return text.erase(at, length);
    case 2:
      return text.insert(at, piece);
    case 3:
      return text.erase(at, length).insert(below(random, text.size() + 1), piece);
    default:
      return text.insert(at, kWords[below(random, kWords.size())]);
  }
}

struct Tally {
  int loaded = 0;
  int refused = 0;
};

/// Loads thousands of damaged texts; any exception but ConfigError escapes and fails the test.
template <class Load>
Tally tally(const std::string& good, int texts, Load load) {
  Tally tally;
  for (int i = 0; i < texts; ++i) {
    RandomStream random(20240501, static_cast<std::uint64_t>(i));
    std::string text = good;
    for (std::size_t edits = 1 + below(random, 3); edits > 0; --edits) text = edited(text, random);
    try {
      load(text);
      ++tally.loaded;
    } catch (const ConfigError& error) {
      EXPECT_FALSE(error.complaint().what.empty());
      EXPECT_FALSE(error.complaint().place.file.empty()) << error.what() << "\n" << text;
      ++tally.refused;
    }
  }
  return tally;
}

TEST(ConfigMutation, DamagedConfigLoadsOrIsRefused) {
  const Tally result = tally(pos::test::kFullConfig, 6000, [](const std::string& text) {
    const RunConfig run = runConfigFrom(parseYaml(text, "/site/run.yaml"), "/share");
    EXPECT_EQ(runConfigFrom(parseYaml(resolvedYaml(run), "/site/run.yaml"), "/share"), run) << text;
  });
  EXPECT_GT(result.loaded, 100);
  EXPECT_GT(result.refused, 3000);
}

TEST(ConfigMutation, DamagedOverrideLoadsOrIsRefused) {
  const YamlDocument document = parseYaml(pos::test::kFullConfig, "/site/run.yaml");
  const Tally result = tally("estimators[1].range_sigma_m=0.3", 3000, [&](const std::string& text) {
    (void)runConfigFrom(applyOverrides(document, {text}), "/share");
  });
  EXPECT_GT(result.loaded, 20);
  EXPECT_GT(result.refused, 1000);
}

TEST(ConfigMutation, DamagedMapLoadsOrIsRefused) {
  const std::string good =
      "schema: 1\nname: mine\norigin: {latitude_deg: 50, longitude_deg: 8, altitude_m: 200}\nanchors:\n"
      "  - {id: 1, name: A, x_m: 1, y_m: 2, z_m: 3}\n  - {id: 2, x_m: 4, y_m: 5, z_m: 6, survey_sigma_m: "
      "0.1}\n"
      "grid: {file: g.yaml, x_m: 1}\n";
  const Tally result = tally(good, 3000, [](const std::string& text) {
    (void)readOptions(parseYaml(text, "map.yaml"), mapOptions());
  });
  EXPECT_GT(result.loaded, 50);
  EXPECT_GT(result.refused, 1000);
}

}  // namespace
}  // namespace pos::io
