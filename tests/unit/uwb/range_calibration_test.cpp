#include "pos/uwb/range_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "pos/core/random.hpp"
#include "pos/uwb/rigid.hpp"

namespace pos::uwb {
namespace {

struct Link {
  double bias;
  Eigen::Vector2d shift;
};

Link truthOf(TagId tag, AnchorId anchor) {
  return {0.1 + 0.03 * anchor - 0.05 * tag,
          tag == 0 ? Eigen::Vector2d(0.02, -0.01) : Eigen::Vector2d(-0.03, 0.0)};
}

/// A body that drives round among six anchors; 20 Hz, 1 % of gross outliers of both signs.
std::vector<CalibrationSample> samplesOf(RandomStream& random, double noise, double outliers) {
  std::vector<CalibrationSample> samples;
  for (int k = 0; k < 600; ++k) {
    const double phase = 0.02 * k;
    const Pose2 pose{2.0 * std::cos(phase), 2.0 * std::sin(phase), wrapAngle(phase + kPi / 2)};
    for (TagId tag = 0; tag < 2; ++tag) {
      for (AnchorId anchor = 0; anchor < 6; ++anchor) {
        const Eigen::Vector3d mount(0.0, tag == 0 ? 0.15 : -0.15, 0.0);
        const Eigen::Vector3d place(6.0 * std::cos(1.05 * anchor), 6.0 * std::sin(1.05 * anchor), 0.4);
        const Link link = truthOf(tag, anchor);
        Eigen::Vector3d electrical = mount;
        electrical.head<2>() += link.shift;
        double range =
            predictedRange(pose, 0.0, electrical, place).distance + link.bias + random.normal(0.0, noise);
        if (random.bernoulli(outliers)) range += random.bernoulli(0.5) ? 3.0 : -2.0;
        samples.push_back({stampFromSeconds(0.05 * k), tag, anchor, mount, place, pose, 0.0, range});
      }
    }
  }
  return samples;
}

TEST(RangeCalibration, BiasesAndShiftsOfEveryLinkAreFoundDespiteOutliers) {
  RandomStream random(1, 1);
  const auto samples = samplesOf(random, 0.02, 0.01);
  const RangeCalibration found = calibratedRanges(samples, {.correlation_time = 0.0});
  ASSERT_EQ(found.links.size(), 12u);
  ASSERT_EQ(found.tags.size(), 2u);
  for (const LinkCalibration& link : found.links) {
    EXPECT_NEAR(link.bias, truthOf(link.tag, link.anchor).bias, 0.005) << link.tag << " " << link.anchor;
    EXPECT_LT(std::abs(link.bias - truthOf(link.tag, link.anchor).bias), 4.0 * link.bias_sigma);
    EXPECT_NEAR(link.residual_sigma, 0.02, 0.004);
  }
  for (const TagCalibration& tag : found.tags) {
    EXPECT_LE((tag.shift - truthOf(tag.tag, 0).shift).norm(), 0.004);
  }
  EXPECT_NEAR(found.residual_sigma, 0.02, 0.001);
  EXPECT_NEAR(found.outliers / 7200.0, 0.01, 0.005);
}

TEST(RangeCalibration, WithoutShiftsOnlyBiasesAreGiven) {
  RandomStream random(2, 1);
  const RangeCalibration found = calibratedRanges(samplesOf(random, 0.02, 0.0), {.shift_sigma = 0.0});
  EXPECT_TRUE(found.tags.empty());
  EXPECT_EQ(found.links.size(), 12u);
}

TEST(RangeCalibration, CorrelatedRangesMakeItLessSure) {
  RandomStream random(3, 1);
  const auto samples = samplesOf(random, 0.02, 0.0);
  const double sure = calibratedRanges(samples, {.correlation_time = 0.0}).links[0].bias_sigma;
  const double doubtful = calibratedRanges(samples, {.correlation_time = 1.0}).links[0].bias_sigma;
  EXPECT_GT(doubtful, 3.0 * sure);  // twenty readings count as one; the prior holds some of it down
}

TEST(RangeCalibration, NothingComesOfNothing) {
  EXPECT_TRUE(calibratedRanges({}, {}).links.empty());
}

/// 20 Hz from a body that drives round, errors as asked: one part new in every reading, one that lasts.
RangeErrors foundFor(double reading_sigma, double lasting_sigma, double lasting_time) {
  RandomStream random(4, 1);
  auto samples = samplesOf(random, 0.0, 0.0);
  std::map<std::pair<TagId, AnchorId>, double> lasting;
  const double keep = std::exp(-0.05 / lasting_time);
  for (CalibrationSample& s : samples) {
    const auto [error, first] = lasting.try_emplace({s.tag, s.anchor}, random.normal(0.0, lasting_sigma));
    if (!first) {
      error->second = keep * error->second + random.normal(0.0, lasting_sigma * std::sqrt(1.0 - keep * keep));
    }
    s.range += error->second + random.normal(0.0, reading_sigma);
  }
  return calibratedRanges(samples, {}).errors;
}

TEST(RangeCalibration, ErrorsThatLastAreToldFromThoseThatDoNot) {
  // 12 links for 30 s: about 360 independent pieces of 0.5 s, so that a sigma is good to some 4 %
  const RangeErrors both = foundFor(0.03, 0.05, 0.5);
  EXPECT_NEAR(both.reading_sigma, 0.03, 0.003);
  EXPECT_NEAR(both.lasting_sigma, 0.05, 0.006);
  EXPECT_NEAR(both.lasting_time, 0.5, 0.15);
  const RangeErrors white = foundFor(0.05, 0.0, 1.0);
  EXPECT_NEAR(white.reading_sigma, 0.05, 0.002);
  EXPECT_LT(white.lasting_sigma, 0.01);
}

}  // namespace
}  // namespace pos::uwb
