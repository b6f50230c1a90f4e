#include "pos/core/edit_distance.hpp"

#include <gtest/gtest.h>

namespace pos {

TEST(EditDistance, CountsDropsAdditionsChangesAndSwaps) {
  EXPECT_EQ(editDistance("", ""), 0U);
  EXPECT_EQ(editDistance("range", "range"), 0U);
  EXPECT_EQ(editDistance("", "abc"), 3U);
  EXPECT_EQ(editDistance("rang", "range"), 1U);
  EXPECT_EQ(editDistance("range", "rage"), 1U);
  EXPECT_EQ(editDistance("range", "ranga"), 1U);
  EXPECT_EQ(editDistance("range", "rnage"), 1U);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(editDistance("Range", "range"), 1U);
}

TEST(EditDistance, IsTheSameBothWays) {
  EXPECT_EQ(editDistance("range_sigma_m", "rang_sgima_cm"), editDistance("rang_sgima_cm", "range_sigma_m"));
}

}  // namespace pos
