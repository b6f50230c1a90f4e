#include "pos/filters/noise_adaptation.hpp"

#include <gtest/gtest.h>

#include "pos/core/random.hpp"

namespace pos::filters {
namespace {

using M2 = Matrix<2, 2>;

/// A linear random walk of two numbers observed with noise; tells what R the adaptation ends with on average.
struct Tracker {
  double process = 0.01;  // variance per step
  Vector<2> noise{1.0, 4.0};

  template <class Each>
  void run(NoiseAdaptation<2>& adaptation, int steps, std::uint64_t seed, Each each) const {
    RandomStream random(seed, 1);
    Vector<2> truth = Vector<2>::Zero();
    Vector<2> x = Vector<2>::Zero();
    M2 P = M2::Identity();
    for (int i = 0; i < steps; ++i) {
      P += process * M2::Identity();
      Vector<2> z;
      for (int k = 0; k < 2; ++k) {
        truth[k] += random.normal(0.0, std::sqrt(process));
        z[k] = truth[k] + random.normal(0.0, std::sqrt(noise[k]));
      }
      const M2 R = adaptation.R();
      const M2 S = P + R;
      const Vector<2> nu = z - x;
      const M2 K = S.ldlt().solve(P).transpose();
      x += K * nu;
      const M2 I_K = M2::Identity() - K;
      P = (I_K * P * I_K.transpose() + K * R * K.transpose()).eval();
      adaptation.learn(nu, S, R);
      each(i, adaptation.R());
    }
  }
};

M2 meanR(NoiseForm form, const Tracker& tracker, int steps = 40000) {
  NoiseAdaptation<2> adaptation({.form = form, .forgetting = 0.98, .variance_min = 1e-6}, M2::Identity());
  M2 sum = M2::Zero();
  int counted = 0;
  tracker.run(adaptation, steps, 7, [&](int i, const M2& R) {
    if (i < steps / 4) return;
    sum += R;
    ++counted;
  });
  return sum / counted;
}

TEST(NoiseAdaptation, ResidualFormEqualsResidualPlusPosteriorCovariance) {
  M2 P, R;
  P << 2.0, 0.3, 0.3, 1.0;
  R << 0.5, 0.1, 0.1, 0.7;
  const M2 S = P + R;
  const Vector<2> nu(0.8, -1.3);
  const M2 K = P * S.inverse();
  const Vector<2> eta = nu - K * nu;
  const M2 posterior = (M2::Identity() - K) * P;
  const M2 expected = eta * eta.transpose() + posterior;
  EXPECT_NEAR((noiseSample<2>(NoiseForm::Residual, nu, S, R) - expected).norm(), 0.0, 1e-12);
}

TEST(NoiseAdaptation, ResidualSampleIsAlwaysPositiveDefinite) {
  RandomStream random(3, 0);
  for (int i = 0; i < 2000; ++i) {
    const double r = random.uniform(1e-6, 5.0);
    const double p = random.uniform(0.0, 50.0);
    const Vector<1> nu(random.normal(0.0, 3.0));
    EXPECT_GT(noiseSample<1>(NoiseForm::Residual, nu, Matrix<1, 1>(p + r), Matrix<1, 1>(r))(0, 0), 0.0);
  }
}

TEST(NoiseAdaptation, SageHusaSampleMayBeNegative) {
  const auto sample =
      noiseSample<1>(NoiseForm::SageHusa, Vector<1>(0.1), Matrix<1, 1>(5.0), Matrix<1, 1>(1.0));
  EXPECT_LT(sample(0, 0), 0.0);
}

// With b = 0.98 the learnt R wanders by about sqrt((1 - b) / (1 + b) * 2) = 14 %; its mean over 30,000
// correlated samples (300 independent ones) is good to 1 %. 5 % is beyond doubt.
TEST(NoiseAdaptation, ResidualAndSageHusaFormsFindTheTrueNoise) {
  for (const NoiseForm form : {NoiseForm::Residual, NoiseForm::SageHusa}) {
    const M2 R = meanR(form, {});
    EXPECT_NEAR(R(0, 0), 1.0, 0.05);
    EXPECT_NEAR(R(1, 1), 4.0, 0.2);
  }
}

TEST(NoiseAdaptation, PrintedFormTendsToTheInnovationCovarianceInstead) {
  const Tracker lively{.process = 1.0};
  const M2 R = meanR(NoiseForm::Printed, lively);
  EXPECT_GT(R(0, 0), 1.5);  // the true value is 1
  const M2 honest = meanR(NoiseForm::Residual, lively);
  EXPECT_NEAR(honest(0, 0), 1.0, 0.1);
}

TEST(NoiseAdaptation, AStepOfNineTimesTheNoiseIsFollowedWithinFiveMemories) {
  constexpr double kForgetting = 0.98;
  NoiseAdaptation<2> adaptation({.forgetting = kForgetting}, M2::Identity());
  Tracker{.noise = {1.0, 1.0}}.run(adaptation, 2000, 5, [](int, const M2&) {});
  M2 last = M2::Zero();
  const int steps = static_cast<int>(5.0 / (1.0 - kForgetting));
  Tracker{.noise = {9.0, 9.0}}.run(adaptation, steps, 6, [&](int, const M2& R) { last = R; });
  EXPECT_NEAR(last(0, 0), 9.0, 4.0);  // 3 sigma of the wandering R
  EXPECT_NEAR(last(1, 1), 9.0, 4.0);
}

TEST(NoiseAdaptation, WarmUpChangesNothingAndTheFirstSampleReplacesOnlyItsShare) {
  NoiseAdaptation<1> adaptation({.form = NoiseForm::Printed, .forgetting = 0.9, .warm_up = 10},
                                Matrix<1, 1>(1.0));
  for (int i = 0; i < 10; ++i) adaptation.learn(Vector<1>(0.0), Matrix<1, 1>(2.0), Matrix<1, 1>(1.0));
  EXPECT_EQ(adaptation.R()(0, 0), 1.0);
  adaptation.learn(Vector<1>(0.0), Matrix<1, 1>(2.0), Matrix<1, 1>(1.0));
  const double d = 0.1 / (1.0 - std::pow(0.9, 12));
  EXPECT_NEAR(adaptation.R()(0, 0), 1.0 - d, 1e-12);
}

TEST(NoiseAdaptation, EigenvaluesStayWithinTheirBounds) {
  NoiseAdaptation<2> adaptation({.forgetting = 0.9, .warm_up = 0, .variance_min = 0.5, .variance_max = 2.0},
                                M2::Identity());
  for (int i = 0; i < 200; ++i) adaptation.learn(Vector<2>(0.0, 100.0), M2::Identity() * 2.0, adaptation.R());
  const Eigen::SelfAdjointEigenSolver<M2> eigen(adaptation.R());
  EXPECT_NEAR(eigen.eigenvalues()[0], 0.5, 1e-9);
  EXPECT_NEAR(eigen.eigenvalues()[1], 2.0, 1e-9);
}

}  // namespace
}  // namespace pos::filters
