#include "pos/estimation/sequencer.hpp"

#include <gtest/gtest.h>

#include "pos/core/random.hpp"

namespace pos::estimation {
namespace {

Measurement at(double t, const std::string& sensor = "s") {
  return {stampFromSeconds(t), sensor, WheelTicks{}};
}

std::vector<std::string> drained(Sequencer& sequencer) {
  std::vector<std::string> order;
  while (const auto m = sequencer.pop()) order.push_back(m->sensor);
  return order;
}

}  // namespace

TEST(Sequencer, WithoutLagEverythingPassesStraightThrough) {
  Sequencer sequencer(Duration{0});
  sequencer.push(at(1.0, "a"));
  EXPECT_EQ(drained(sequencer), std::vector<std::string>{"a"});
  sequencer.push(at(0.5, "late"));
  EXPECT_EQ(drained(sequencer), std::vector<std::string>{"late"});
}

TEST(Sequencer, HoldsBackUntilTheLagHasPassed) {
  Sequencer sequencer(durationFromSeconds(0.5));
  sequencer.push(at(1.0, "b"));
  EXPECT_TRUE(drained(sequencer).empty());
  sequencer.push(at(0.8, "a"));
  sequencer.push(at(1.4, "c"));
  EXPECT_EQ(drained(sequencer), std::vector<std::string>{"a"});
  sequencer.finish();
  EXPECT_EQ(drained(sequencer), (std::vector<std::string>{"b", "c"}));
}

TEST(Sequencer, EqualStampsKeepTheOrderTheyCameIn) {
  Sequencer sequencer(durationFromSeconds(1.0));
  for (const char* name : {"one", "two", "three", "four"}) sequencer.push(at(2.0, name));
  sequencer.finish();
  EXPECT_EQ(drained(sequencer), (std::vector<std::string>{"one", "two", "three", "four"}));
}

TEST(Sequencer, ShuffledWithinTheLagComesOutSorted) {
  RandomStream random(1, 0);
  Sequencer sequencer(durationFromSeconds(1.0));
  Stamp last{};
  int count = 0;
  const auto check = [&] {
    while (const auto m = sequencer.pop()) {
      EXPECT_GE(m->stamp, last);
      last = m->stamp;
      ++count;
    }
  };
  for (int i = 0; i < 2000; ++i) {
    sequencer.push(at(0.01 * i + random.uniform(0.0, 0.99)));
    check();
  }
  sequencer.finish();
  check();
  EXPECT_EQ(count, 2000);
}

}  // namespace pos::estimation
