#include "pos/estimation/dual_uwb_models.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pos/core/error.hpp"
#include "support/numeric_jacobian.hpp"

namespace pos::estimation {
namespace {

using Variant = DualUwbConfig::Variant;
using Motion = DualUwbConfig::Motion;

struct Kind {
  Variant variant;
  Motion motion;
  double link_sigma;
};
const std::vector<Kind> kKinds{{Variant::Filter, Motion::Vehicle, 0.0},
                               {Variant::Filter, Motion::Free, 0.0},
                               {Variant::FilterGyro, Motion::Vehicle, 0.0},
                               {Variant::FilterGyro, Motion::Free, 0.05},
                               {Variant::Filter, Motion::Vehicle, 0.05}};
constexpr int kAnchors = 2;

DualUwbConfig configOf(const Kind& kind) {
  DualUwbConfig config;
  config.variant = kind.variant;
  config.motion = kind.motion;
  config.link_bias.sigma = kind.link_sigma;
  config.tags = {{0, {0.1, 0.4, 0.0}}, {1, {-0.1, -0.4, 0.0}}};
  config.motion_centre_x = 0.7;
  config.course_offset = 0.1;
  return config;
}

DualUwbState stateAt(const DualUwbLayout& layout, double yaw) {
  DualUwbState x{DualUwbState::Values::Zero(layout.size())};
  x.values.head<3>() << 2.0, -1.0, yaw;
  x.values[3] = 1.3;
  if (!layout.vehicle()) x.values[4] = -0.4;
  x.values[layout.rateRow()] = 0.3;
  for (int i = layout.core(); i < layout.size(); ++i) x.values[i] = 0.01 * i;
  return x;
}

const std::vector<double> kYaws{0.0, 1e-7, 1.0, -2.0, kPi - 1e-7, -kPi + 1e-7};
constexpr GyroInput kGyro{0.5, 0.002};

template <class Function>
void expectRow(const DualUwbRow& row, const DualUwbState& x, const Function& nu) {
  const auto numeric = pos::testing::numericJacobian(
      x, static_cast<int>(x.values.size()),
      [&](const DualUwbState& y) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, nu(y)); });
  EXPECT_LE((row.H + numeric).norm(), 1e-7 * (1.0 + numeric.norm())) << row.H << "\n" << -numeric;
}

TEST(DualUwbModels, StepHasTheJacobianItClaims) {
  for (const Kind& kind : kKinds) {
    const DualUwbConfig config = configOf(kind);
    const DualUwbLayout layout(config, kAnchors);
    const DualUwbMotion motion{&layout, &config};
    for (const double yaw : kYaws) {
      for (const double dt : {0.01, 0.5}) {
        const DualUwbState x = stateAt(layout, yaw);
        const Eigen::VectorXd next = motion.step(x, kGyro, dt).next;
        const Eigen::MatrixXd numeric =
            pos::testing::numericJacobian(x, layout.size(), [&](const DualUwbState& y) -> Eigen::VectorXd {
              Eigen::VectorXd d = motion.step(y, kGyro, dt).next - next;
              d[2] = wrapAngle(d[2]);
              return d;
            }).leftCols(layout.core());
        EXPECT_LE((motion.step(x, kGyro, dt).F - numeric).norm(), 1e-7) << "yaw " << yaw;
      }
    }
  }
}

TEST(DualUwbModels, RangeWheelAndLateralRowsHaveTheJacobiansTheyClaim) {
  const uwb::BodyRange range{1, {-0.1, -0.4, 0.5}, {9.0, 4.0, 2.0}, 8.0, 0.05};
  for (const Kind& kind : kKinds) {
    const DualUwbConfig config = configOf(kind);
    const DualUwbLayout layout(config, kAnchors);
    for (const double yaw : kYaws) {
      const DualUwbState x = stateAt(layout, yaw);
      const auto ranged = [&](const DualUwbState& y) { return rangeInnovation(y, layout, range, 0.2, 1, 1); };
      expectRow(ranged(x), x, [&](const DualUwbState& y) { return ranged(y).nu[0]; });
      const auto wheel = [&](const DualUwbState& y) {
        return wheelInnovation(y, layout, config, 1.0, kGyro);
      };
      expectRow(wheel(x), x, [&](const DualUwbState& y) { return wheel(y).nu[0]; });
      if (layout.vehicle()) continue;
      const auto lateral = [&](const DualUwbState& y) { return lateralInnovation(y, layout, config, kGyro); };
      expectRow(lateral(x), x, [&](const DualUwbState& y) { return lateral(y).nu[0]; });
    }
  }
}

TEST(DualUwbModels, ZeroTimeIsTheIdentity) {
  for (const Kind& kind : kKinds) {
    const DualUwbConfig config = configOf(kind);
    const DualUwbLayout layout(config, kAnchors);
    const DualUwbState x = stateAt(layout, 3.0);
    const DualUwbStep step = DualUwbMotion{&layout, &config}.step(x, kGyro, 0.0);
    EXPECT_EQ(step.next, x.values.head(layout.core()));
    EXPECT_TRUE(step.F.isIdentity(0.0));
    EXPECT_TRUE(step.Qd.isZero(0.0));
  }
}

TEST(DualUwbModels, ProcessNoiseHasNoNegativeDirection) {
  for (const Kind& kind : kKinds) {
    const DualUwbConfig config = configOf(kind);
    const DualUwbLayout layout(config, kAnchors);
    const DualUwbStep step = DualUwbMotion{&layout, &config}.step(stateAt(layout, 1.0), kGyro, 0.3);
    const Eigen::MatrixXd Q = step.Qd;
    EXPECT_LE((Q - Q.transpose()).norm(), 1e-15);
    for (int k = 0; k < 50; ++k) {
      const Eigen::VectorXd v = Eigen::VectorXd::NullaryExpr(
          Q.rows(), [&](Eigen::Index i) { return std::sin(1.0 + 3.7 * static_cast<double>(i) + 1.3 * k); });
      EXPECT_GE(v.dot(Q * v), -1e-15);
    }
  }
}

TEST(DualUwbModels, SparsePredictionIsTheDenseOne) {
  DualUwbConfig config = configOf(kKinds.back());
  for (const double time : {0.0, 0.4}) {
    config.link_bias = {0.02, 0.05, time > 0.0 ? 0.0 : 0.1, time};
    const DualUwbLayout layout(config, kAnchors);
    const int n = layout.size();
    const DualUwbMotion motion{&layout, &config};
    Belief<DualUwbState> belief;
    belief.mean = stateAt(layout, 0.4);
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [](Eigen::Index i, Eigen::Index j) {
      return std::sin(1.0 + 2.3 * static_cast<double>(i) + 0.7 * static_cast<double>(j * j));
    });
    belief.covariance = root * root.transpose();
    const DualUwbStep step = motion.step(belief.mean, {}, 0.2);
    Eigen::MatrixXd F = Eigen::MatrixXd::Identity(n, n);
    F.topLeftCorner(layout.core(), layout.core()) = step.F;
    F.diagonal().tail(layout.links()).setConstant(time > 0.0 ? std::exp(-0.2 / time) : 1.0);
    Eigen::MatrixXd dense = F * belief.covariance * F.transpose();
    dense.topLeftCorner(layout.core(), layout.core()) += step.Qd;
    const double forgotten = 0.05 * 0.05 * (1.0 - std::exp(-0.4 / 0.4));
    dense.diagonal().tail(layout.links()).array() += time > 0.0 ? forgotten : 0.1 * 0.1 * 0.2;
    const double bias = belief.mean.values[layout.core()];
    predict(belief, step);
    EXPECT_LE((belief.covariance - dense).norm(), 1e-12 * dense.norm());
    EXPECT_NEAR(belief.mean.values[layout.core()], 0.02 + F(layout.core(), layout.core()) * (bias - 0.02),
                1e-15);
  }
}

TEST(DualUwbModels, ABiasThatForgetsItselfKeepsItsSigmaHoweverTheTimeIsCut) {
  DualUwbConfig config = configOf(kKinds.back());
  config.link_bias = {0.02, 0.05, 0.0, 0.7};
  const DualUwbLayout layout(config, kAnchors);
  const DualUwbMotion motion{&layout, &config};
  Belief<DualUwbState> belief{stateAt(layout, 0.4),
                              TangentMatrix<DualUwbState>::Zero(layout.size(), layout.size())};
  belief.covariance.diagonal().tail(layout.links()).setConstant(0.05 * 0.05);
  for (int k = 0; k < 100; ++k) predict(belief, motion.standing(belief.mean, 0.3));
  for (int i = layout.core(); i < layout.size(); ++i) {
    EXPECT_NEAR(belief.covariance(i, i), 0.05 * 0.05, 1e-12);
    EXPECT_NEAR(belief.mean.values[i], 0.02, 1e-12);
  }
}

TEST(DualUwbModels, AVehicleTurnsAboutItsMotionCentre) {
  DualUwbConfig config = configOf(kKinds.front());
  config.course_offset = 0.0;
  const DualUwbLayout layout(config, 1);
  DualUwbState x = stateAt(layout, 0.3);
  x.values[3] = 0.0;  // spinning on the spot: the point 0.7 m behind the body frame stays where it is
  const Pose2 before = x.pose();
  const double dt = 1e-3;
  const auto next = DualUwbMotion{&layout, &config}.step(x, {}, dt).next;
  const Eigen::Vector2d centre(-config.motion_centre_x, 0.0);
  const Pose2 after{next[0], next[1], next[2]};
  EXPECT_LE((after * centre - before * centre).norm(), 1e-7);
}

TEST(DualUwbModels, TwistIsTheVelocityInBodyAxesWithItsCovariance) {
  for (const Kind& kind : kKinds) {
    const DualUwbConfig config = configOf(kind);
    const DualUwbLayout layout(config, kAnchors);
    const int n = layout.size();
    Belief<DualUwbState> belief{stateAt(layout, 2.5), TangentMatrix<DualUwbState>::Identity(n, n)};
    const auto rates = [&](const DualUwbState& y) -> Eigen::VectorXd {
      return twistOf({y, belief.covariance}, layout, config, {0.5, 0.0}).rates;
    };
    const PlanarTwist twist = twistOf(belief, layout, config, {0.5, 0.0});
    const auto J = pos::testing::numericJacobian(belief.mean, n, rates);
    EXPECT_LE((twist.covariance - J * J.transpose()).norm(), 1e-6);
    // the displacement over a short step, seen from the body
    const double dt = 1e-6;
    const auto next = DualUwbMotion{&layout, &config}.step(belief.mean, {0.5, 0.0}, dt).next;
    const Eigen::Vector2d moved = (next.head<2>() - belief.mean.values.head<2>()) / dt;
    EXPECT_LE((rotation2(2.5).transpose() * moved - twist.rates.head<2>()).norm(), 1e-5);
    EXPECT_NEAR((next[2] - 2.5) / dt, twist.rates[2], 1e-6);
  }
}

TEST(DualUwbModels, TooManyLinksAreRefused) {
  DualUwbConfig config = configOf(kKinds.back());
  EXPECT_NO_THROW(DualUwbLayout(config, 29));
  EXPECT_THROW(DualUwbLayout(config, 30), ConfigError);
}

}  // namespace
}  // namespace pos::estimation
