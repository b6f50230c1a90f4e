#include "pos/core/verdict.hpp"

#include <gtest/gtest.h>

#include <set>

namespace pos {

TEST(Verdict, EveryOneHasItsOwnName) {
  std::set<std::string_view> names;
  for (const Verdict verdict : kVerdicts) names.insert(name(verdict));
  EXPECT_EQ(names, (std::set<std::string_view>{"applied", "gated", "too_old", "unsupported", "degenerate",
                                               "not_initialised"}));
}

TEST(Verdict, ValueOutsideTheListIsCalledUnknown) {
  EXPECT_EQ(name(static_cast<Verdict>(200)), "unknown");
}

TEST(IngestReport, ClaimsNothingUntilFilled) {
  const IngestReport report;
  EXPECT_EQ(report.verdict, Verdict::Unsupported);
  EXPECT_EQ(report.dof, 0);
  EXPECT_TRUE(report.reason.empty());
}

}  // namespace pos
