#include "pos/filters/particle_set.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/random.hpp"
#include "pos/filters/propagation.hpp"
#include "support/particle_oracle.hpp"

namespace pos::filters {
namespace {

ParticleSet cloud(std::size_t count, const Pose2& centre, double sigma, std::uint64_t seed) {
  RandomStream random(seed, 1);
  ParticleSet set;
  set.origin = centre.translation();
  set.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double a = random.normal();
    const double b = random.normal();
    const double c = random.normal();
    set.place(i, plus(centre, sigma * Vector<3>(a, b, 0.3 * c)));
    set.weight[i] = static_cast<float>(std::exp(random.normal()));
  }
  return set;
}

/// The same sums, slowly and in double.
Moments slowMoments(const ParticleSet& set) {
  double total = 0.0;
  Vector<3> sum = Vector<3>::Zero();
  Pose2 mean;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const double w = static_cast<double>(set.weight[i]);
    const Pose2 p = set.pose(i);
    total += w;
    sum += w * Vector<3>(p.x, p.y, 0.0);
    mean.x += w * std::cos(p.yaw);
    mean.y += w * std::sin(p.yaw);
  }
  mean = {sum.x() / total, sum.y() / total, std::atan2(mean.y, mean.x)};
  Matrix<3, 3> P = Matrix<3, 3>::Zero();
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Vector<3> d = minus(set.pose(i), mean);
    P += static_cast<double>(set.weight[i]) / total * d * d.transpose();
  }
  return {mean, P};
}

}  // namespace

TEST(ParticleSet, MomentsAgreeWithDoublePrecisionAcrossTheYawSeam) {
  const ParticleSet set = cloud(500, {350123.5, -20417.25, kPi - 0.05}, 0.4, 7);
  const Moments fast = moments(set);
  const Moments slow = slowMoments(set);
  EXPECT_NEAR(fast.mean.x, slow.mean.x, 1e-6);
  EXPECT_NEAR(fast.mean.y, slow.mean.y, 1e-6);
  EXPECT_NEAR(wrapAngle(fast.mean.yaw - slow.mean.yaw), 0.0, 1e-6);
  EXPECT_TRUE(fast.covariance.isApprox(slow.covariance, 1e-5)) << fast.covariance << "\n\n"
                                                               << slow.covariance;
}

TEST(ParticleSet, NormaliseReturnsTheEvidence) {
  ParticleSet set;
  set.resize(2);
  set.weight = {0.5F * 2.0F, 1.5F * 6.0F};  // shares 1/4 and 3/4, likelihoods 2 and 6: evidence 5
  set.log_scale = 40.0;
  EXPECT_NEAR(normalise(set), std::log(5.0) + 40.0, 1e-6);
  EXPECT_NEAR(set.weight[0], 2.0 * 0.1, 1e-6);
  EXPECT_NEAR(set.weight[1], 2.0 * 0.9, 1e-6);
  EXPECT_EQ(set.log_scale, 0.0);
}

TEST(ParticleSet, RescalingKeepsTheLikelihoods) {
  ParticleSet set = cloud(300, {}, 1.0, 4);
  for (float& w : set.weight) w *= 1e-20F;
  set.log_scale = 3.0;
  const double before = logEvidence(set);
  rescale(set);
  EXPECT_NEAR(logEvidence(set), before, 1e-5);
  EXPECT_NEAR(weightSums(set).first, 300.0, 1e-3);
}

TEST(ParticleSet, WeighingByLogLikelihoodsSurvivesTinyAndHugeOnes) {
  for (const float far : {-5000.0F, 0.0F, 5000.0F}) {
    ParticleSet set;
    set.resize(3);
    set.weight = {1.0F, 2.0F, 3.0F};
    FloatArray values{far + 1.0F, far, far - 200.0F};
    const Weighed weighed = weigh(set, values, 0.5);
    EXPECT_NEAR(weighed.log_scale, 0.5 * (far + 1.0), 1e-3);
    EXPECT_NEAR(values[0], 1.0, 1e-6);
    EXPECT_NEAR(values[1], 2.0 * std::exp(-0.5), 1e-5);
    EXPECT_LT(values[2], 1e-29F);  // e^-100 is held at the least weight
    EXPECT_GE(values[2], kLeastWeight);
    EXPECT_NEAR(weighed.log_evidence, 0.5 * far + std::log((std::exp(0.5) + 2.0) / 6.0), 1e-3);
  }
}

TEST(ParticleSet, HeadingsAreThoseOfTheParticles) {
  const ParticleSet set = cloud(77, {0.0, 0.0, 3.0}, 1.0, 2);
  HeadingTable table;
  fillHeadings(table, set);
  ASSERT_EQ(table.cosine.size(), 77U);
  for (std::size_t i = 0; i < set.size(); ++i) {
    EXPECT_NEAR(table.cosine[i], std::cos(set.pose(i).yaw), 1e-6);
    EXPECT_NEAR(table.sine[i], std::sin(set.pose(i).yaw), 1e-6);
  }
}

TEST(ParticleSet, OriginMovesWithoutMovingTheParticles) {
  ParticleSet set = cloud(50, {1000.0, 2000.0, 0.3}, 2.0, 3);
  const Pose2 before = set.pose(17);
  moveOrigin(set, {1100.0, 1950.0});
  EXPECT_NEAR(minus(set.pose(17), before).norm(), 0.0, 2e-5);
  EXPECT_EQ(set.origin.x(), 1100.0);
}

TEST(Propagation, WithoutNoiseItIsPoseComposition) {
  ParticleSet set = cloud(700, {5.0, 6.0, 2.9}, 1.0, 11);
  const ParticleSet before = set;
  const Pose2 step{0.7, -0.2, 0.9};
  HeadingTable headings;
  propagate(set, headings, {step, Vector<3>::Zero()}, 1, 1);
  for (std::size_t i = 0; i < set.size(); ++i) {
    EXPECT_LT(minus(set.pose(i), before.pose(i) * step).norm(), 3e-6) << i;
    EXPECT_NEAR(headings.cosine[i], std::cos(set.pose(i).yaw), 1e-6);
    EXPECT_NEAR(headings.sine[i], std::sin(set.pose(i).yaw), 1e-6);
  }
}

TEST(Propagation, EveryParticleMovesAsInDoublePrecision) {
  const NoisyStep motion{{0.7, -0.2, 0.3}, {0.3, 0.1, 0.05}};
  ParticleSet set = cloud(203, {5.0, 6.0, 2.9}, 1.0, 11);
  const ParticleSet before = set;
  HeadingTable headings;
  const std::uint64_t seed = 0x1234567890abcdefU;
  const std::uint64_t step = 0x500000003U;
  propagate(set, headings, motion, seed, step);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Pose2 expected = oracle::moved(before.pose(i), motion, seed, step, i);
    EXPECT_LT(minus(set.pose(i), expected).norm(), 1e-5) << i;
  }
}

TEST(Propagation, NoiseHasTheGivenSpreadInTheBodyFrame) {
  constexpr std::size_t kCount = 40000;
  ParticleSet set;
  set.resize(kCount);
  for (std::size_t i = 0; i < kCount; ++i) set.place(i, {0.0, 0.0, 0.5 * kPi});
  levelWeights(set);
  HeadingTable headings;
  propagate(set, headings, {{1.0, 0.0, 0.1}, {0.3, 0.1, 0.05}}, 42, 9);
  const Moments m = moments(set);
  // The body looks along map y, so "along" is y. A variance of n normals is good to sqrt(2 / n) = 0.7 %; 4
  // sigma.
  EXPECT_NEAR(m.covariance(1, 1), 0.09, 0.09 * 0.03);
  EXPECT_NEAR(m.covariance(0, 0), 0.01, 0.01 * 0.03);
  EXPECT_NEAR(m.covariance(2, 2), 0.0025, 0.0025 * 0.03);
  EXPECT_NEAR(m.mean.y, 1.0, 4.0 * 0.3 / 200.0);
  EXPECT_NEAR(m.mean.x, 0.0, 4.0 * 0.1 / 200.0);
  EXPECT_NEAR(m.mean.yaw, 0.5 * kPi + 0.1, 4.0 * 0.05 / 200.0);
  for (const auto& [row, column] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
    const double correlation =
        m.covariance(row, column) / std::sqrt(m.covariance(row, row) * m.covariance(column, column));
    EXPECT_NEAR(correlation, 0.0, 4.0 / 200.0);
  }
}

TEST(Propagation, ParticleNoiseDependsOnSeedStepAndIndexOnly) {
  ParticleSet few;
  few.resize(10);
  ParticleSet many;
  many.resize(1000);
  ParticleSet other_step = few;
  ParticleSet other_seed = few;
  const NoisyStep motion{{}, {1.0, 1.0, 0.1}};
  HeadingTable headings;
  propagate(few, headings, motion, 5, 8);
  propagate(many, headings, motion, 5, 8);
  propagate(other_step, headings, motion, 5, 9);
  propagate(other_seed, headings, motion, 6, 8);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few.x[i], many.x[i]);
    EXPECT_NE(few.x[i], other_step.x[i]);
    EXPECT_NE(few.x[i], other_seed.x[i]);
  }
}

}  // namespace pos::filters
