/// The checks, run over the project itself. POS_SOURCE_DIR is its root.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "structure/checks.hpp"

namespace pos::structure {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = POS_SOURCE_DIR;

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Files under `folder` in a fixed order, without what is built, fetched or kept by git itself.
std::vector<fs::path> filesUnder(const fs::path& folder) {
  static const std::set<std::string> kSkipped{"build", "out", ".git", "node_modules", "dist", ".cache"};
  std::set<fs::path> files;
  if (!fs::exists(folder)) return {};
  for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::end(entry); ++entry) {
    if (kSkipped.count(entry->path().filename().string()) > 0) {
      entry.disable_recursion_pending();
    } else if (entry->is_regular_file()) {
      files.insert(entry->path());
    }
  }
  return {files.begin(), files.end()};
}

/// Every source of the library as (path, "module/file").
std::vector<std::pair<fs::path, std::string>> librarySources() {
  std::vector<std::pair<fs::path, std::string>> sources;
  for (const fs::path& base : {kRoot / "libpos/include/pos", kRoot / "libpos/src"}) {
    for (const fs::path& file : filesUnder(base)) {
      sources.emplace_back(file, fs::relative(file, base).generic_string());
    }
  }
  return sources;
}

void expectNone(const fs::path& file, const Findings& findings) {
  for (const Finding& finding : findings) {
    ADD_FAILURE() << fs::relative(file, kRoot).generic_string() << ':' << finding.line << ": "
                  << finding.what;
  }
}

bool isText(const std::string& text) {
  return text.substr(0, 4096).find('\0') == std::string::npos;
}

}  // namespace

TEST(Tree, LibraryFollowsTheArrowsTable) {
  const Arrows arrows = parsedArrows(contents(kRoot / "tests/structure/arrows.txt"));
  const auto sources = librarySources();
  ASSERT_GT(sources.size(), 20U);
  for (const auto& [path, name] : sources) expectNone(path, forbiddenIncludes(arrows, name, contents(path)));
}

TEST(Tree, LibraryHasNoClockConsoleExitOrUnseededRandomness) {
  for (const auto& [path, name] : librarySources()) expectNone(path, forbiddenCalls(contents(path)));
}

TEST(Tree, FiltersNameNoSensor) {
  for (const auto& [path, name] : librarySources()) {
    if (name.rfind("filters/", 0) == 0) expectNone(path, sensorNames(contents(path)));
  }
}

TEST(Tree, NoFileHoldsAPathOfOneMachine) {
  for (const fs::path& file : filesUnder(kRoot)) {
    const std::string text = contents(file);
    if (isText(text)) expectNone(file, machinePaths(text));
  }
}

TEST(Tree, LinksOfTheDocumentsResolve) {
  int documents = 0;
  for (const fs::path& file : filesUnder(kRoot)) {
    if (file.extension() != ".md") continue;
    ++documents;
    expectNone(file, brokenLinks(contents(file), [&](const std::string& link) {
                 return fs::exists(file.parent_path() / link);
               }));
  }
  EXPECT_GE(documents, 5);
}

}  // namespace pos::structure
