#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "complaint.hpp"
#include "pos/io/files.hpp"
#include "pos/io/yaml_document.hpp"

namespace pos::io {
namespace {

using pos::test::complaintOf;
using testing::HasSubstr;

Complaint refusal(const std::string& text) {
  return complaintOf([&] { return parseYaml(text, "c.yaml"); });
}

TEST(ConfigYaml, PlacesAreThoseOfTheEditor) {
  const YamlDocument document = parseYaml("a: 1\nlist:\n  - x: 'two'\n    y: [3, 4]\n", "c.yaml");
  const YamlNode& item = document.root.find("list")->items[0];
  EXPECT_EQ(toString(item.place), "c.yaml:3:5");
  EXPECT_EQ(toString(item.find("x")->place), "c.yaml:3:8");
  EXPECT_EQ(toString(item.placeOfKey("y")), "c.yaml:4:5");
  EXPECT_EQ(toString(item.find("y")->items[1].place), "c.yaml:4:12");
  EXPECT_TRUE(item.find("x")->quoted);
  EXPECT_FALSE(document.root.find("a")->quoted);
}

TEST(ConfigYaml, DuplicateKeyIsRefusedWithBothLines) {
  const Complaint complaint = refusal("list:\n  - a: 1\n    b: 2\n    a: 3\n");
  EXPECT_EQ(complaint.what, "the key 'a' is given twice");
  EXPECT_EQ(toString(complaint.place), "c.yaml:4:5");
  EXPECT_EQ(complaint.key, "list[0].a");
  EXPECT_EQ(complaint.suggestion, "it stands in line 2 already; keep one of the two");
}

TEST(ConfigYaml, SyntaxErrorHasItsLine) {
  const Complaint complaint = refusal("a: 1\nb: [1, 2\nc: 3\n");
  EXPECT_THAT(complaint.what, HasSubstr("this is not YAML: "));
  EXPECT_EQ(complaint.place.file, "c.yaml");
  EXPECT_EQ(complaint.place.line, 3);
  EXPECT_EQ(refusal("a: b: c\n").place.line, 1);
  EXPECT_EQ(refusal("a: 1\n\tb: 2\n").place.line, 2);
}

TEST(ConfigYaml, WhatOthersReadInSilenceIsRefused) {
  EXPECT_THAT(refusal("a: &x 1\n").what, HasSubstr("anchors"));
  EXPECT_THAT(refusal("a: *x\n").what, HasSubstr("anchor is not defined"));
  EXPECT_THAT(refusal("a: !!str 1\n").what, HasSubstr("tags"));
  EXPECT_EQ(refusal("a: 1\n---\nb: 2\n").what, "a second YAML document (---) begins in the same file");
  EXPECT_EQ(refusal("").what, "the file is empty");
  EXPECT_EQ(refusal("# only a comment\n").what, "the file is empty");
  EXPECT_THAT(refusal("[a, b]: 1\n").what, HasSubstr("a key has to be a single word"));
  EXPECT_EQ(refusal("{: 1}\n").what, "a key is missing before the colon");
}

TEST(ConfigYaml, CharactersThatAreNoTextAreRefusedAtTheirPlace) {
  const Complaint complaint = refusal("a: 1\nb: \x04 2\n");
  EXPECT_EQ(toString(complaint.place), "c.yaml:2:4");
  EXPECT_EQ(complaint.got, "byte 4");
  EXPECT_EQ(toString(refusal("a: \xc3\xa9\xff\n").place), "c.yaml:1:5") << "columns count characters";
  EXPECT_EQ(refusal(std::string("a\0b", 3)).got, "byte 0");
}

TEST(ConfigYaml, DeepNestingIsRefused) {
  EXPECT_EQ(refusal(std::string(100, '[') + std::string(100, ']')).what,
            "lists and tables are nested too deep");
  EXPECT_FALSE(refusal(std::string(100000, '[')).what.empty());
  EXPECT_FALSE(refusal(std::string(100000, '{')).what.empty());
}

TEST(ConfigYaml, TextSurvivesWritingAndReading) {
  YamlNode root = tableNode();
  for (const char* text : {"plain", "1", "true", "null", "with space", "a: b", "#c", "\"q\"", "it's", "\\",
                           "- x", "line\nbreak", "tab\t", "\x01", "\xc3\xa9", "a.b/c-d", ""}) {
    root.add(std::string("k") + text, textNode(text));
  }
  YamlNode list = listNode();
  list.items = {plainNode("1"), tableNode(), listNode(), root};
  YamlNode top = tableNode();
  top.add("list", list);
  top.add("root", root);
  const YamlNode back = parseYaml(yamlText(top), "c.yaml").root;
  EXPECT_EQ(jsonText(parseYaml(jsonText(root), "c.json").root), jsonText(root));
  ASSERT_EQ(back.items[1].items.size(), root.items.size());
  for (std::size_t i = 0; i < root.items.size(); ++i) {
    EXPECT_EQ(back.items[1].items[i].text, root.items[i].text);
    EXPECT_EQ(back.items[1].keys[i].name, root.keys[i].name);
  }
  EXPECT_EQ(yamlText(back), yamlText(top));
}

TEST(ConfigYaml, CommentsStandAboveTheirKeys) {
  YamlNode item = tableNode();
  YamlNode value = plainNode("1");
  value.comment = "What it is.\nMore.";
  item.add("a", value);
  YamlNode list = listNode();
  list.items = {item};
  YamlNode top = tableNode();
  top.add("list", list);
  EXPECT_EQ(yamlText(top), "list:\n  -\n    # What it is.\n    # More.\n    a: 1\n");
  EXPECT_EQ(parseYaml(yamlText(top), "c.yaml").root.items[0].items[0].find("a")->text, "1");
}

class ConfigFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "uwb_demo.yaml") << "a: 1\n";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(ConfigFiles, MissingFileNamesFolderAndNearName) {
  const Complaint complaint = complaintOf([&] { return loadYaml(folder_ / "uwb_dmeo.yaml"); });
  EXPECT_EQ(complaint.what, "the file does not exist");
  EXPECT_EQ(complaint.got, (folder_ / "uwb_dmeo.yaml").string());
  EXPECT_EQ(complaint.expected, "a file in the folder " + folder_.string());
  EXPECT_EQ(complaint.suggestion, "did you mean uwb_demo.yaml?");
}

TEST_F(ConfigFiles, MissingFolderIsNamed) {
  const Complaint complaint = complaintOf([&] { return loadYaml(folder_ / "no" / "x.yaml"); });
  EXPECT_THAT(complaint.expected, HasSubstr("there is no folder " + (folder_ / "no").string()));
}

TEST_F(ConfigFiles, FolderInsteadOfFileIsRefused) {
  EXPECT_EQ(complaintOf([&] { return loadYaml(folder_); }).what, "this is a folder, not a file");
}

TEST_F(ConfigFiles, EmptyFileIsRefused) {
  std::ofstream(folder_ / "empty.yaml").flush();
  EXPECT_EQ(complaintOf([&] { return loadYaml(folder_ / "empty.yaml"); }).what, "the file is empty");
}

TEST_F(ConfigFiles, ExistingFileIsRead) {
  EXPECT_EQ(loadYaml(folder_ / "uwb_demo.yaml").root.find("a")->text, "1");
}

TEST(ConfigPaths, StartAtTheFolderOrTheShare) {
  EXPECT_EQ(resolvedPath("../maps/m.yaml", "/site/configs", "/share"), "/site/maps/m.yaml");
  EXPECT_EQ(resolvedPath("/abs/m.yaml", "/site/configs", "/share"), "/abs/m.yaml");
  EXPECT_EQ(resolvedPath("mrpt-common:datasets/a.rawlog", "/site", "/share"), "/share/datasets/a.rawlog");
  EXPECT_TRUE(resolvedPath("m.yaml", "", "/share").is_absolute());
}

}  // namespace
}  // namespace pos::io
