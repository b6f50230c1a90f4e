#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "pos/core/random.hpp"
#include "pos/io/csv_import.hpp"
#include "scratch_folder.hpp"

namespace pos::io {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kGood = R"(name: test
streams:
  - kind: ranges
    file: r.csv
    columns:
      stamp: {column: t, unit: s}
      tag: {value: 1}
      anchor: {column: a}
      range: {column: r, unit: m}
truth:
  file: t.csv
  columns:
    stamp: {column: t, unit: s}
    x: {column: x, unit: m}
    y: {column: y, unit: m}
anchors:
  - {id: 1, x_m: 1, y_m: 2, z_m: 3}
)";

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = kGood;
  text.replace(text.find(from), from.size(), to);
  return text;
}

std::string complaint(const std::string& text) {
  return complaintOf<ConfigError>([&] { parseImportMapping(text, "m.yaml"); });
}

TEST(CsvMapping, ReadsAGoodOne) {
  const ImportMapping mapping = parseImportMapping(kGood, "m.yaml");
  ASSERT_EQ(mapping.streams.size(), 1U);
  EXPECT_EQ(mapping.streams[0].file, "r.csv");
  EXPECT_EQ(mapping.streams[0].sensor, "ranges");
  EXPECT_EQ(mapping.streams[0].fields.at(1).constant, 1.0);
  EXPECT_EQ(mapping.truth->fields.size(), 3U);
  EXPECT_EQ(mapping.listed_anchors.at(0).p_map, Eigen::Vector3d(1, 2, 3));
}

TEST(CsvMapping, UnknownKeyNamesPlacePathAndSuggestion) {
  EXPECT_THAT(
      complaint(replaced("file: r.csv", "fille: r.csv")),
      AllOf(HasSubstr("m.yaml:4:5"), HasSubstr("streams[0].fille"), HasSubstr("did you mean 'file'?")));
  EXPECT_THAT(complaint(replaced("anchor: {column", "anchr: {column")),
              AllOf(HasSubstr("m.yaml:8:7"), HasSubstr("streams[0].columns.anchr"), HasSubstr("'anchor'")));
}

TEST(CsvMapping, MissingKeysAreNamed) {
  EXPECT_THAT(complaint(replaced("name: test\n", "")), HasSubstr("'name' is missing"));
  EXPECT_THAT(complaint(replaced("    file: r.csv\n", "")),
              AllOf(HasSubstr("m.yaml:3:5"), HasSubstr("streams[0].file")));
  EXPECT_THAT(complaint(replaced("      range: {column: r, unit: m}\n", "")),
              HasSubstr("streams[0].columns.range"));
  EXPECT_THAT(complaint(replaced(", z_m: 3", "")), HasSubstr("anchors[0].z_m"));
}

TEST(CsvMapping, RepeatedKeysAreRefused) {
  EXPECT_THAT(complaint(replaced("file: r.csv\n", "file: r.csv\n    file: s.csv\n")),
              AllOf(HasSubstr("m.yaml:5:5"), HasSubstr("there twice")));
}

TEST(CsvMapping, UnitsAreCheckedAgainstTheQuantity) {
  EXPECT_THAT(complaint(replaced("{column: r, unit: m}", "{column: r, unit: rad}")),
              AllOf(HasSubstr("m.yaml:9:32"), HasSubstr("streams[0].columns.range.unit"), HasSubstr("'rad'"),
                    HasSubstr("one of m, cm, mm, km")));
  EXPECT_THAT(complaint(replaced("{column: r, unit: m}", "{column: r}")), HasSubstr("'unit' is missing"));
  EXPECT_THAT(complaint(replaced("{column: a}", "{column: a, unit: m}")),
              HasSubstr("this field has no unit"));
}

TEST(CsvMapping, WrongTypesAreRefused) {
  EXPECT_THAT(complaint(replaced("{column: a}", "a")), HasSubstr("expected a map"));
  EXPECT_THAT(complaint(replaced("{value: 1}", "{value: one}")), HasSubstr("expected a number"));
  EXPECT_THAT(complaint(replaced("id: 1", "id: 1.5")), HasSubstr("expected a whole number"));
  EXPECT_THAT(complaint(replaced("x_m: 1", "x_m: 1m")), HasSubstr("anchors[0].x_m"));
  EXPECT_THAT(complaint("name: x\nstreams: {}\n"), HasSubstr("expected a list"));
  EXPECT_THAT(complaint("name: x\nstreams: []\n"), HasSubstr("there are no streams"));
  EXPECT_THAT(complaint("name: [x]\nstreams: []\n"), HasSubstr("expected a text"));
  EXPECT_THAT(complaint("- 1\n"), HasSubstr("expected a map"));
  EXPECT_THAT(complaint(""), HasSubstr("expected a map"));
}

TEST(CsvMapping, UnknownWordsListTheKnownOnes) {
  EXPECT_THAT(complaint(replaced("kind: ranges", "kind: range")),
              AllOf(HasSubstr("m.yaml:3:11"), HasSubstr("gnss"), HasSubstr("did you mean 'ranges'?")));
  EXPECT_THAT(complaint(replaced("file: r.csv", "file: r.csv\n    bad_rows: drop")),
              HasSubstr("refuse or skip"));
}

TEST(CsvMapping, AFieldHasEitherAColumnOrAValue) {
  EXPECT_THAT(complaint(replaced("{value: 1}", "{value: 1, column: t}")),
              HasSubstr("either a column or a value"));
  EXPECT_THAT(complaint(replaced("{value: 1}", "{}")), HasSubstr("either a column or a value"));
  EXPECT_THAT(complaint(replaced("stamp: {column: t, unit: s}", "stamp: {value: 1, unit: s}")),
              HasSubstr("stamps need a column"));
}

TEST(CsvMapping, AmbiguousTruthAttitudeIsRefused) {
  const std::string y = "    y: {column: y, unit: m}\n";
  EXPECT_THAT(complaint(replaced(y, y + "    qw: {column: w}\n")), HasSubstr("all of qw qx qy qz"));
}

TEST(CsvMapping, FixCodesAndFixStatusComeTogether) {
  EXPECT_THAT(complaint(replaced("file: r.csv", "file: r.csv\n    fix_codes: {0: none}")),
              HasSubstr("unknown key"));
  std::string gnss =
      "name: x\nstreams:\n  - kind: gnss\n    file: a.csv\n    columns:\n      stamp: {column: t, unit: s}\n";
  for (const char* field : {"altitude", "sigma_east", "sigma_north", "sigma_up"}) {
    gnss += std::string("      ") + field + ": {value: 1, unit: m}\n";
  }
  for (const char* field : {"latitude", "longitude"}) {
    gnss += std::string("      ") + field + ": {column: l, unit: deg}\n";
  }
  EXPECT_NO_THROW(parseImportMapping(gnss, "m.yaml"));
  EXPECT_THAT(complaint(gnss + "      fix_status: {column: q}\n"), HasSubstr("go together"));
  EXPECT_THAT(complaint(gnss + "      fix_status: {column: q}\n    fix_codes: {4: rtk}\n"),
              AllOf(HasSubstr("unknown fix quality"), HasSubstr("rtk_fixed")));
}

TEST(CsvMapping, BrokenYamlNamesThePlace) {
  EXPECT_THAT(complaint("name: [x\nstreams: }"), AllOf(HasSubstr("m.yaml:"), HasSubstr("not good YAML")));
}

TEST(CsvMapping, MissingFileIsNamed) {
  const ScratchFolder folder;
  EXPECT_THAT(complaintOf<ConfigError>([&] { readImportMapping(folder.path() / "no.yaml"); }),
              HasSubstr("no.yaml"));
}

TEST(CsvMapping, TheProjectsMappingsLoad) {
  for (const char* name : {"plaza", "lias", "hanyang"}) {
    const auto path =
        std::filesystem::path(POS_SOURCE_DIR) / "configs/import" / (std::string(name) + ".yaml");
    EXPECT_EQ(readImportMapping(path).name, name);
  }
}

TEST(CsvMapping, EveryUnitIsKnownForOneQuantityOnly) {
  std::vector<std::string> all;
  for (const Quantity quantity : {Quantity::Time, Quantity::Length, Quantity::Angle, Quantity::AngularRate,
                                  Quantity::Speed, Quantity::Acceleration, Quantity::Power}) {
    for (const std::string& unit : unitsOf(quantity)) {
      EXPECT_GT(unitFactor(quantity, unit).value_or(0.0), 0.0);
      EXPECT_EQ(std::count(all.begin(), all.end(), unit), 0) << unit;
      all.push_back(unit);
    }
  }
  EXPECT_TRUE(unitsOf(Quantity::Plain).empty());
}

std::string mutated(std::string text, RandomStream& random) {
  static const std::string kAlphabet = ":{}[],-\n #&*!|>'\"0x\t";
  const std::size_t at = random.bits() % text.size();
  const char c = kAlphabet[random.bits() % kAlphabet.size()];
  if (random.bernoulli(0.3)) return text.erase(at, 1 + random.bits() % 3);
  if (random.bernoulli(0.5)) return text.insert(at, 1, c);
  text[at] = c;
  return text;
}

/// How many of `trials` calls of `load` load; all others must throw a pos::Error.
template <class Load>
int countLoaded(int trials, const Load& load) {
  int loaded = 0;
  for (int i = 0; i < trials; ++i) {
    try {
      load();
      ++loaded;
    } catch (const Error& error) {
      EXPECT_FALSE(std::string(error.what()).empty());
    }
  }
  return loaded;
}

TEST(CsvMapping, MutatedMappingLoadsOrThrowsAnError) {
  RandomStream random(11, 0);
  const int loaded = countLoaded(5000, [&] {
    std::string text = mutated(kGood, random);
    if (random.bernoulli(0.5)) text = mutated(text, random);
    parseImportMapping(text, "m.yaml");
  });
  EXPECT_GT(loaded, 100);  // the fuzz reaches both ends
  EXPECT_LT(loaded, 4000);
}

TEST(CsvMapping, MutatedTableLoadsOrThrowsAnError) {
  const ScratchFolder folder;
  folder.write("t.csv", "t,x,y\n0,1,2\n1,2,3\n");
  const ImportMapping mapping = parseImportMapping(kGood, "m.yaml");
  RandomStream random(12, 0);
  const int loaded = countLoaded(200, [&] {
    folder.write("r.csv", mutated("t,a,r\n0.5,1,2.5\n0.75,1,3.5\n", random));
    for (const Measurement& m : importCsv(mapping, folder.path()).measurements) EXPECT_FALSE(defect(m));
  });
  EXPECT_GT(loaded, 10);
  EXPECT_LT(loaded, 180);
}

TEST(CsvMapping, TheExampleInTheDocumentationLoads) {
  std::ostringstream text;
  text << std::ifstream(std::filesystem::path(POS_SOURCE_DIR) / "docs/howto/import_csv.md").rdbuf();
  const std::string page = text.str();
  const std::size_t begin = page.find("```yaml\n") + 8;
  const ImportMapping mapping =
      parseImportMapping(page.substr(begin, page.find("```", begin) - begin), "import_csv.md");
  EXPECT_EQ(mapping.streams.size(), 2U);
  EXPECT_EQ(mapping.streams[1].bad_rows, BadRows::Skip);
  EXPECT_EQ(mapping.listed_tags.size(), 1U);
}

TEST(CsvMapping, TheDocumentationListsEveryKindAndField) {
  std::ostringstream text;
  text << std::ifstream(std::filesystem::path(POS_SOURCE_DIR) / "docs/howto/import_csv.md").rdbuf();
  std::vector<TableSpec> specs = streamSpecs();
  specs.insert(specs.end(), {truthSpec(), anchorsSpec(), tagsSpec()});
  for (const TableSpec& spec : specs) {
    const std::size_t begin = text.str().find("| `" + spec.kind + "` |");
    ASSERT_NE(begin, std::string::npos) << spec.kind;
    const std::string row = text.str().substr(begin, text.str().find('\n', begin) - begin);
    for (const FieldSpec& field : spec.fields) EXPECT_THAT(row, HasSubstr(field.name)) << spec.kind;
  }
}

}  // namespace
}  // namespace pos::io
