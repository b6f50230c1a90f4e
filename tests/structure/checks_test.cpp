/// The checkers find what they are meant to find, and let pass what is right.
#include "structure/checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pos::structure {
namespace {

const Arrows kArrows = parsedArrows(
    "# comment\n[modules]\ncore:\nmap: core\nfilters: core\nio: core map\n[libraries]\n"
    "mrpt: io\nboost: core/chi_square.cpp\n");

int count(const Findings& findings) {
  return static_cast<int>(findings.size());
}

}  // namespace

TEST(Arrows, ForbiddenArrowIsFoundWithItsLine) {
  const Findings found =
      forbiddenIncludes(kArrows, "map/a.hpp", "#pragma once\n#include \"pos/io/log.hpp\"\n");
  ASSERT_EQ(count(found), 1);
  EXPECT_EQ(found[0].line, 2);
  EXPECT_EQ(found[0].what, "map may not include pos/io/log.hpp");
}

TEST(Arrows, OwnAndAllowedModulesPass) {
  EXPECT_EQ(count(forbiddenIncludes(kArrows, "map/a.cpp",
                                    "#include \"pos/map/a.hpp\"\n#include \"pos/core/angle.hpp\"\n"
                                    "#include <Eigen/Core>\n#include <vector>\n")),
            0);
}

TEST(Arrows, OutsideLibraryIsOnlyForItsModuleOrFile) {
  EXPECT_EQ(count(forbiddenIncludes(kArrows, "map/a.cpp", "#include <mrpt/obs/CRawlog.h>\n")), 1);
  EXPECT_EQ(count(forbiddenIncludes(kArrows, "io/a.cpp", "#include <mrpt/obs/CRawlog.h>\n")), 0);
  EXPECT_EQ(count(forbiddenIncludes(kArrows, "core/a.cpp", "#include <boost/math/x.hpp>\n")), 1);
  EXPECT_EQ(count(forbiddenIncludes(kArrows, "core/chi_square.cpp", "#include <boost/math/x.hpp>\n")), 0);
}

TEST(Arrows, ModuleWithoutARowAndClimbingIncludeAreFound) {
  EXPECT_EQ(count(forbiddenIncludes(kArrows, "radar/a.hpp", "#include \"pos/core/angle.hpp\"\n")), 1);
  EXPECT_EQ(count(forbiddenIncludes(kArrows, "map/a.hpp", "#include \"../io/log.hpp\"\n")), 1);
}

TEST(Arrows, IncludeInACommentDoesNotCount) {
  EXPECT_EQ(count(forbiddenIncludes(kArrows, "map/a.hpp",
                                    "// #include \"pos/io/log.hpp\"\n/*\n#include \"pos/io/log.hpp\"\n*/\n")),
            0);
}

TEST(Arrows, TableWithALineThatIsNoRowIsRefused) {
  EXPECT_THROW(parsedArrows("[modules]\ncore core\n"), std::runtime_error);
  EXPECT_THROW(parsedArrows("core: map\n"), std::runtime_error);
}

TEST(Comments, AreBlankedAndTextIsKept) {
  EXPECT_EQ(withoutComments("a /* b\nc */ d // e\nf"), "a     \n     d     \nf");
  EXPECT_EQ(withoutComments(R"(x = "// no"; y = '"'; // yes)"), R"(x = "// no"; y = '"';       )");
  EXPECT_EQ(withoutComments("1'000 // e"), "1'000     ");
}

TEST(LibraryCode, ClockConsoleExitAndRandomDeviceAreFound) {
  for (const char* bad : {"std::random_device d;", "auto t = std::chrono::system_clock::now();",
                          "auto t = steady_clock::now();", "std::cout << 1;", "std::cerr << 1;", "exit(1);",
                          "std::abort ();", "std::printf(\"x\");", "int i = rand();"}) {
    EXPECT_EQ(count(forbiddenCalls(bad)), 1) << bad;
  }
}

TEST(LibraryCode, LookAlikesPass) {
  for (const char* good : {"// std::cout << 1;", "int exitCode() const;", "operand(1);", "snprintf(b, n, f);",
                           "texit(1);", "LogClock::time_point now;"}) {
    EXPECT_EQ(count(forbiddenCalls(good)), 0) << good;
  }
}

TEST(Filters, SensorNamesAreFoundOutsideComments) {
  EXPECT_EQ(count(sensorNames("void correct(const BeaconRange& r);")), 1);
  EXPECT_EQ(count(sensorNames("void correct(const ImuSample&, const Scan2D&);")), 2);
  EXPECT_EQ(count(sensorNames("/// after a BeaconRange\nvoid correct(const MyBeaconRangeModel& r);")), 0);
}

TEST(MachinePaths, AreFoundAndOrdinaryPathsPass) {
  const std::string slash = "/";
  for (const std::string folder : {"work", "root", "home", "tmp"}) {
    EXPECT_EQ(count(machinePaths("file: " + slash + folder + "/x.rawlog")), 1) << folder;
    EXPECT_EQ(count(machinePaths(slash + folder + "/x.rawlog")), 1) << folder;
  }
  EXPECT_EQ(count(machinePaths("see docs/tmp/x, /usr/share/mrpt, homework/root/a, $X/tmp/y")), 0);
}

TEST(Links, MissingTargetIsFoundAndOthersPass) {
  const auto exists = [](const std::string& path) { return path == "there.md"; };
  const Findings found = brokenLinks("[a](there.md)\n[b](gone.md#part) ![c](gone.png \"title\")\n", exists);
  ASSERT_EQ(count(found), 2);
  EXPECT_EQ(found[0].line, 2);
  EXPECT_EQ(count(brokenLinks("[a](https://x.org) [b](#here) [c](there.md#part) [d](mailto:x@y)", exists)),
            0);
  EXPECT_EQ(count(brokenLinks("```\n[a](gone.md)\n```\n", exists)), 0);
}

}  // namespace pos::structure
