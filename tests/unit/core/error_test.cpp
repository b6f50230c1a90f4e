#include "pos/core/error.hpp"

#include <gtest/gtest.h>

namespace pos {

TEST(FilePlace, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ(toString(FilePlace{"site.yaml", 12, 5}), "site.yaml:12:5");
  EXPECT_EQ(toString(FilePlace{"site.yaml", 12, 0}), "site.yaml:12");
  EXPECT_EQ(toString(FilePlace{"site.yaml", 0, 5}), "site.yaml");
  EXPECT_EQ(toString(FilePlace{}), "");
}

TEST(Complaint, TellsEveryFieldOnItsOwnLine) {
  const Complaint complaint{.what = "range sigma is negative",
                            .place = {"a.yaml", 3, 7},
                            .key = "estimators[1].range_std_m",
                            .got = "-0.1",
                            .expected = "> 0 m",
                            .suggestion = "use 0.1"};
  EXPECT_EQ(toString(complaint),
            "a.yaml:3:7: range sigma is negative\n  key:      estimators[1].range_std_m\n  got:      -0.1\n"
            "  expected: > 0 m\n  try:      use 0.1");
}

TEST(Complaint, LeavesEmptyFieldsOut) {
  EXPECT_EQ(toString(Complaint{.what = "no such log", .got = "x.rawlog"}),
            "no such log\n  got:      x.rawlog");
}

TEST(Error, CarriesItsComplaintAndText) {
  const ConfigError error(Complaint{.what = "unknown key", .key = "rnge"});
  EXPECT_STREQ(error.what(), "unknown key\n  key:      rnge");
  EXPECT_EQ(error.complaint().key, "rnge");
  EXPECT_STREQ(DataError("log is empty").what(), "log is empty");
}

TEST(Error, EveryKindHasItsExitCode) {
  EXPECT_EQ(Error("x").exitCode(), 1);
  EXPECT_EQ(UsageError("x").exitCode(), 2);
  EXPECT_EQ(ConfigError("x").exitCode(), 3);
  EXPECT_EQ(RequirementMissed("x").exitCode(), 4);
  EXPECT_EQ(DataError("x").exitCode(), 5);
}

TEST(Error, CaughtAsTheBaseItKeepsItsExitCode) {
  try {
    throw DataError("short log");
  } catch (const Error& error) {
    EXPECT_EQ(error.exitCode(), 5);
  }
}

TEST(Ensure, ThrowsOnlyWhenTheConditionDoesNotHold) {
  EXPECT_NO_THROW(ensure(true, "fine"));
  try {
    ensure(false, "weights sum to one");
    FAIL() << "nothing was thrown";
  } catch (const ContractError& error) {
    EXPECT_STREQ(error.what(), "weights sum to one");
  }
}

}  // namespace pos
