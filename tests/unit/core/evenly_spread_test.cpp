#include "pos/core/evenly_spread.hpp"

#include <gtest/gtest.h>

namespace pos {
namespace {

std::vector<int> keptOf(std::size_t most, int length) {
  EvenlySpread<int> series(most);
  for (int i = 0; i < length; ++i) series.add(i);
  EXPECT_EQ(series.seen(), static_cast<std::size_t>(length));
  return series.take();
}

TEST(EvenlySpread, KeepsAllOfAShortSeries) {
  EXPECT_EQ(keptOf(4, 0), std::vector<int>{});
  EXPECT_EQ(keptOf(4, 4), (std::vector<int>{0, 1, 2, 3}));
}

TEST(EvenlySpread, HalvesWhenItIsFull) {
  EXPECT_EQ(keptOf(4, 5), (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(keptOf(4, 9), (std::vector<int>{0, 4, 8}));
  EXPECT_EQ(keptOf(5, 6), (std::vector<int>{0, 2, 4}));
}

TEST(EvenlySpread, KeepsEvenDistancesBetweenHalfFullAndFullForEveryLength) {
  for (std::size_t most = 2; most < 12; ++most) {
    for (int length = 1; length < 200; ++length) {
      const std::vector<int> kept = keptOf(most, length);
      ASSERT_LE(kept.size(), most);
      ASSERT_GE(2 * kept.size(), std::min(most, static_cast<std::size_t>(length)));
      const int step = kept.size() > 1 ? kept[1] : length;
      for (std::size_t i = 0; i < kept.size(); ++i) ASSERT_EQ(kept[i], step * static_cast<int>(i));
      ASSERT_GT(kept.back() + step, length - 1);
    }
  }
}

}  // namespace
}  // namespace pos
