#include "pos/sim/bias_law.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "sensor_scene.hpp"

namespace pos::sim {

using scene::meanBand;
using scene::meanOf;

TEST(BiasLaw, UniformHasItsMeanAndLimits) {
  RandomStream random(1, 1);
  std::vector<double> values;
  for (int i = 0; i < 50000; ++i) values.push_back(drawn(BiasLaw::uniform(0.3, 1.5), random));
  EXPECT_NEAR(meanOf(values), 0.9, meanBand(1.2 / std::sqrt(12.0), values.size()));
  EXPECT_GE(*std::min_element(values.begin(), values.end()), 0.3);
  EXPECT_LE(*std::max_element(values.begin(), values.end()), 1.5);
}

TEST(BiasLaw, CutExponentialHasTheMeanOfItsTruncatedLaw) {
  RandomStream random(1, 2);
  std::vector<double> values;
  for (int i = 0; i < 50000; ++i) values.push_back(drawn(BiasLaw::exponential(0.6, 0.5, 2.0), random));
  const double x = 1.5 / 0.6;
  const double mean = 0.5 + 0.6 - 1.5 / std::expm1(x);  // of an exponential cut off at 1.5 above 0.5
  EXPECT_NEAR(meanOf(values), mean, meanBand(scene::sigmaOf(values), values.size()));
  EXPECT_LE(*std::max_element(values.begin(), values.end()), 2.0);
  EXPECT_GE(*std::min_element(values.begin(), values.end()), 0.5);

  std::vector<double> endless;
  for (int i = 0; i < 50000; ++i) endless.push_back(drawn(BiasLaw::exponential(0.6), random));
  EXPECT_NEAR(meanOf(endless), 0.6, meanBand(0.6, endless.size()));
}

TEST(BiasLaw, RefusesALawThatCannotBe) {
  EXPECT_THROW((void)validated(BiasLaw::uniform(1.0, 0.5), "b"), ConfigError);
  EXPECT_THROW((void)validated(BiasLaw::exponential(0.0), "b"), ConfigError);
}

}  // namespace pos::sim
