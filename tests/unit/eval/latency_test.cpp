#include "pos/eval/latency.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/error.hpp"
#include "pos/core/pose2.hpp"
#include "pos/core/random.hpp"

namespace pos::eval {
namespace {

Eigen::Vector2d placeAt(double t) {
  return {8.0 * std::sin(0.3 * t), 5.0 * std::sin(0.47 * t)};
}

/// The path sampled at `rate`, its stamps `late` seconds behind, in a frame of its own, with noise.
std::vector<TimedPosition> path(double rate, double late, const Pose2& T_frame_map, double noise) {
  RandomStream random(5, static_cast<std::uint64_t>(rate));
  std::vector<TimedPosition> result;
  for (double t = 0.0; t < 60.0; t += 1.0 / rate) {
    const Eigen::Vector2d n(random.normal(0.0, noise), random.normal(0.0, noise));
    result.push_back({stampFromSeconds(100.0 + t + late), T_frame_map * placeAt(t) + n});
  }
  return result;
}

}  // namespace

TEST(Latency, IsFoundWhateverTheTwoFrames) {
  for (const double late : {-0.3, 0.0, 0.18, 0.5}) {
    const auto fit = fittedLatency(path(8.0, late, {}, 0.1), path(5.0, 0.0, {30.0, -7.0, 2.1}, 0.02), 1.0);
    EXPECT_NEAR(fit.latency, late, 0.02) << late;
    EXPECT_LE(fit.residual, fit.residual_at_zero);
    EXPECT_NEAR(fit.residual, 0.1 * std::sqrt(2.0), 0.05);
  }
}

TEST(Latency, AStandingVehicleIsRefused) {
  std::vector<TimedPosition> still;
  for (int i = 0; i < 100; ++i) still.push_back({stampFromSeconds(0.1 * i), {1.0, 2.0}});
  EXPECT_THROW((void)fittedLatency(still, still, 1.0), DataError);
}

TEST(Latency, PathsThatDoNotOverlapAreRefused) {
  auto later = path(8.0, 0.0, {}, 0.0);
  for (TimedPosition& p : later) p.stamp += durationFromSeconds(1000.0);
  EXPECT_THROW((void)fittedLatency(later, path(8.0, 0.0, {}, 0.0), 1.0), DataError);
}

TEST(Latency, GapsOfTheReferenceAreNotBridged) {
  auto reference = path(5.0, 0.0, {}, 0.0);
  std::erase_if(reference, [](const TimedPosition& p) {
    const double t = seconds(p.stamp - stampFromSeconds(100.0));
    return t > 20.0 && t < 40.0;
  });
  const auto fit = fittedLatency(path(8.0, 0.2, {}, 0.0), reference, 0.5);
  EXPECT_NEAR(fit.latency, 0.2, 0.02);
  EXPECT_LT(fit.pairs, 330U);
}

}  // namespace pos::eval
