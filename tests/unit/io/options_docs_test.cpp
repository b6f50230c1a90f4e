#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "pos/io/map_yaml.hpp"
#include "pos/io/run_config.hpp"

namespace pos::io {
namespace {

using testing::HasSubstr;

/// Every key of a table and below, as full paths, in the spelling of the reference.
void collect(const TableCore& table, const std::string& prefix, std::set<std::string>& keys) {
  for (const OptionRow& row : table.rows) {
    keys.insert(prefix + row.option.key);
    if (!row.table) continue;
    collect(*row.table, prefix + row.option.key + (row.option.kind == Option::Kind::List ? "[]." : "."),
            keys);
    for (const Alternative& alternative : row.table->alternatives) collect(*alternative.table, "", keys);
  }
}

template <class T>
std::set<std::string> keysOf(const OptionTable<T>& table) {
  std::set<std::string> keys;
  collect(*table.core(), "", keys);
  return keys;
}

template <class T>
void expectComplete(const OptionTable<T>& table) {
  const std::string reference = markdownReference(table);
  const std::string schema = jsonSchema(table);
  for (const std::string& key : keysOf(table)) {
    EXPECT_THAT(reference, HasSubstr("| `" + key + "` |"));
    EXPECT_THAT(schema, HasSubstr("\"" + key.substr(key.rfind('.') + 1) + "\": {"));
  }
}

void expectSentences(const TableCore& table) {
  for (const OptionRow& row : table.rows) {
    EXPECT_TRUE(row.option.text.ends_with('.')) << row.option.key << ": " << row.option.text;
    EXPECT_EQ(row.option.text.find('|'), std::string::npos) << row.option.key;
    if (row.table) expectSentences(*row.table);
  }
  for (const Alternative& alternative : table.alternatives) expectSentences(*alternative.table);
}

TEST(OptionsDocs, ReferenceAndSchemaListEveryKey) {
  EXPECT_GT(keysOf(runOptions()).size(), 100u);
  expectComplete(runOptions());
  expectComplete(mapOptions());
}

void expectUniqueKeys(const TableCore& table, const std::set<std::string>& outer) {
  std::set<std::string> keys = outer;
  for (const OptionRow& row : table.rows) {
    EXPECT_TRUE(keys.insert(row.option.key).second) << row.option.key;
    if (row.table) expectUniqueKeys(*row.table, {});
  }
  for (const Alternative& alternative : table.alternatives) expectUniqueKeys(*alternative.table, keys);
}

TEST(OptionsDocs, NoTableBindsAKeyTwice) {
  expectUniqueKeys(*runOptions().core(), {});
  expectUniqueKeys(*mapOptions().core(), {});
}

TEST(OptionsDocs, EveryKeyIsExplainedInASentence) {
  expectSentences(*runOptions().core());
  expectSentences(*mapOptions().core());
}

TEST(OptionsDocs, ReferenceRowShowsUnitRangeAndDefault) {
  const std::string reference = markdownReference(runOptions());
  EXPECT_THAT(
      reference,
      HasSubstr("| `sequencer.lag_s` | number | s | 0 to 3600 | `0` | How late a measurement may come"));
  EXPECT_THAT(reference, HasSubstr("| `schema` | whole number |  | 1 | required |"));
  EXPECT_THAT(reference, HasSubstr("## `type: range_odometry`"));
  EXPECT_THAT(reference, HasSubstr("| `range_scale.value` | number |  | 0.5 to 2 | `1` |"));
  EXPECT_THAT(reference, HasSubstr("| `range_offset.value_m` | number | m | -100 to 100 | `0` |"));
  EXPECT_THAT(reference, HasSubstr("| `faults.seed` | whole number |  | >= 0 | absent |"));
}

TEST(OptionsDocs, SchemaRefusesOtherKeys) {
  const std::string schema = jsonSchema(runOptions());
  EXPECT_THAT(schema, HasSubstr("\"$schema\": \"https://json-schema.org/draft/2020-12/schema\""));
  EXPECT_THAT(schema, HasSubstr("\"additionalProperties\": false"));
  EXPECT_THAT(schema, HasSubstr("\"const\": \"mcl\""));
}

TEST(OptionsDocs, SchemaIsBalancedJson) {
  // yaml-cpp reads JSON, so our own strict reader proves the text well formed and free of duplicates.
  const YamlDocument document = parseYaml(jsonSchema(mapOptions()), "schema.json");
  const YamlNode* anchors = document.root.find("properties")->find("anchors");
  ASSERT_NE(anchors, nullptr);
  const YamlNode* required = anchors->find("items")->find("required");
  ASSERT_NE(required, nullptr);
  EXPECT_EQ(inlineText(*required), "[id, x_m, y_m, z_m]");
}

}  // namespace
}  // namespace pos::io
