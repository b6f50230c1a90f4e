#pragma once
/// The laws every manifold state obeys, as one typed test suite. A test file gives its types:
///
///   template <> struct pos::ManifoldSamples<MyState> { static std::vector<MyState> states(); };
///   INSTANTIATE_TYPED_TEST_SUITE_P(MyState, ManifoldLaws, ::testing::Types<MyState>);
///
/// `states()` should hold the origin, ordinary states and states near the seams of the angles.

#include <gtest/gtest.h>

#include <vector>

#include "pos/core/manifold.hpp"
#include "pos/core/random.hpp"

namespace pos {

template <class X>
struct ManifoldSamples;

template <class X>
class ManifoldLaws : public ::testing::Test {
 protected:
  using Step = Tangent<X>;
  static constexpr int kTangents = 8;  ///< random tangents a state
  static constexpr double kTolerance = 1e-10;

  /// Uniform in the box of half width `size`, as long as the tangents of x; the same ones in every run.
  static std::vector<Step> tangents(const X& x, double size) {
    const Step zero = minus(x, x);
    RandomStream random(20231, static_cast<std::uint64_t>(zero.size()));
    std::vector<Step> list(kTangents, zero);
    for (Step& d : list) {
      for (Eigen::Index i = 0; i < d.size(); ++i) d[i] = random.uniform(-size, size);
    }
    return list;
  }
};

TYPED_TEST_SUITE_P(ManifoldLaws);

TYPED_TEST_P(ManifoldLaws, PlusZeroChangesNothing) {
  for (const TypeParam& x : ManifoldSamples<TypeParam>::states()) {
    typename TestFixture::Step zero = minus(x, x);
    zero.setZero();
    const typename TestFixture::Step d = minus(plus(x, zero), x);
    EXPECT_LE(d.cwiseAbs().maxCoeff(), TestFixture::kTolerance);
  }
}

TYPED_TEST_P(ManifoldLaws, MinusItselfIsZero) {
  for (const TypeParam& x : ManifoldSamples<TypeParam>::states()) {
    EXPECT_LE(minus(x, x).cwiseAbs().maxCoeff(), TestFixture::kTolerance);
  }
}

TYPED_TEST_P(ManifoldLaws, PlusOfMinusArrives) {
  const std::vector<TypeParam> states = ManifoldSamples<TypeParam>::states();
  for (const TypeParam& x : states) {
    for (const TypeParam& y : states) {
      const typename TestFixture::Step missed = minus(plus(x, minus(y, x)), y);
      EXPECT_LE(missed.cwiseAbs().maxCoeff(), TestFixture::kTolerance);
    }
  }
}

TYPED_TEST_P(ManifoldLaws, MinusOfPlusGivesTheTangentBack) {
  for (const double size : {1e-9, 1e-6, 1e-3, 1.0}) {
    for (const TypeParam& x : ManifoldSamples<TypeParam>::states()) {
      for (const auto& d : this->tangents(x, size)) {
        const typename TestFixture::Step error = minus(plus(x, d), x) - d;
        EXPECT_LE(error.cwiseAbs().maxCoeff(), 1e-12 + TestFixture::kTolerance * size)
            << "tangent " << d.transpose();
      }
    }
  }
}

TYPED_TEST_P(ManifoldLaws, SmallStepsMoveSmoothly) {
  constexpr double kStep = 1e-6;
  for (const TypeParam& x : ManifoldSamples<TypeParam>::states()) {
    for (const auto& d : this->tangents(x, 1.0)) {
      const typename TestFixture::Step there = kStep * d;
      const typename TestFixture::Step back = -kStep * d;
      const typename TestFixture::Step forward = minus(plus(x, there), x);
      const typename TestFixture::Step backward = minus(plus(x, back), x);
      EXPECT_LE(((forward - backward) / (2.0 * kStep) - d).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
}

REGISTER_TYPED_TEST_SUITE_P(ManifoldLaws, PlusZeroChangesNothing, MinusItselfIsZero, PlusOfMinusArrives,
                            MinusOfPlusGivesTheTangentBack, SmallStepsMoveSmoothly);

}  // namespace pos
