/// What ranges and scans do to the particles' weights, against double precision, and the same bits from every
/// instruction set.
#include <gtest/gtest.h>

#include <cmath>

#include "pos/estimation/range_likelihood.hpp"
#include "pos/estimation/scan_weights.hpp"
#include "support/mcl_scene.hpp"

namespace pos::estimation {
namespace {

class Weights : public ::testing::Test {
 protected:
  void SetUp() override {
    RandomStream random(21, 2);
    set.origin = {1000.0, 500.0};
    set.resize(333);
    for (std::size_t i = 0; i < set.size(); ++i) {
      const double x = 1000.0 + random.normal(0.0, 2.0);
      const double y = 500.0 + random.normal(0.0, 2.0);
      set.place(i, {x, y, random.uniform(-kPi, kPi)});
      set.weight[i] = static_cast<float>(std::exp(random.normal()));
    }
    fillHeadings(headings, set);
    grid.T_map_grid = {996.0, 496.0, 0.3};
  }

  /// What apply added to the logarithm of a weight.
  double gained(const filters::ParticleSet& after, std::size_t i) const {
    return std::log(static_cast<double>(after.weight[i]) / static_cast<double>(set.weight[i])) +
           after.log_scale - set.log_scale;
  }

  filters::ParticleSet set;
  filters::HeadingTable headings;
  map::OccupancyGrid grid = scene::room();
  ScanLikelihood scan{.sigma = 0.2, .outlier_probability = 0.3, .distance_max = 1.0};
  RangeTerm term{.anchor = {6.0, -3.0, 4.0},
                 .tag = {0.5, -0.3, 1.2},
                 .range = 7.3,
                 .sigma = 0.4,
                 .outlier_probability = 0.2,
                 .range_max = 50.0,
                 .exponent = 1.0};
};

class OfARange : public Weights, public ::testing::WithParamInterface<double> {};

}  // namespace

TEST_P(OfARange, AgreeWithDoublePrecision) {
  term.exponent = GetParam();
  filters::ParticleSet after = set;
  RangeWeights weights;
  const RangeSums sums = weights.evaluate(set, headings, term);
  weights.apply(after);
  double total = 0.0, good = 0.0, mean = 0.0, square = 0.0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Eigen::Vector2d tag = set.pose(i) * Eigen::Vector2d(0.5, -0.3);
    const double d = (Eigen::Vector3d(1006.0, 497.0, 4.0) - Eigen::Vector3d(tag.x(), tag.y(), 1.2)).norm();
    const double nu = 7.3 - d;
    const double inlier = 0.8 / (std::sqrt(2.0 * kPi) * 0.4) * std::exp(-0.5 * nu * nu / 0.16);
    const double w = set.weight[i];
    total += w;
    good += w * inlier;
    mean += w * d;
    square += w * d * d;
    EXPECT_NEAR(gained(after, i), GetParam() * std::log(inlier + 0.004), 2e-5) << i;
  }
  EXPECT_NEAR(sums.evidence, good / total + 0.004, 1e-6);
  EXPECT_NEAR(sums.inlier_share, good / total / (good / total + 0.004), 1e-5);
  EXPECT_NEAR(sums.predicted, mean / total, 1e-5);
  EXPECT_NEAR(sums.predicted_variance, square / total - std::pow(mean / total, 2), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Exponents, OfARange, ::testing::Values(1.0, 0.7, 0.02));

TEST_F(Weights, ManyUnlikelyRangesLeaveThemFinite) {
  term.range = 45.0;
  term.outlier_probability = 0.001;
  const RangeSums first = RangeWeights().evaluate(set, headings, term);
  filters::ParticleSet after = set;
  RangeWeights weights;
  for (int k = 0; k < 40; ++k) {
    weights.evaluate(after, headings, term);
    weights.apply(after);
  }
  // Every particle holds the same 0.001 / 50 m forty times over.
  EXPECT_NEAR(filters::logEvidence(after) - filters::logEvidence(set), 40.0 * std::log(2e-5), 1e-3);
  EXPECT_NEAR(first.evidence, 2e-5, 1e-10);
  EXPECT_NEAR(filters::effectiveSize(after) / filters::effectiveSize(set), 1.0, 1e-4);
}

TEST_F(Weights, OfAScanAreTheFieldSeenFromEachParticle) {
  ScanWeights weights(grid, scan);
  const lidar::LikelihoodField field({.columns = grid.columns,
                                      .rows = grid.rows,
                                      .resolution = grid.resolution,
                                      .x_min = grid.x_min,
                                      .y_min = grid.y_min,
                                      .occupancy = grid.occupancy},
                                     {.sigma = 0.2, .outlier_probability = 0.3, .distance_max = 1.0});
  const lidar::BeamPoints beam{.x = {2.0F}, .y = {0.7F}, .weight = {0.5F}};
  filters::ParticleSet after = set;
  weights.evaluate(set, headings, beam, 0.6);
  weights.apply(after);
  int different = 0;  // a point within rounding of a cell border may fall to either side
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Eigen::Vector2d p_grid = inverse(grid.T_map_grid) * (set.pose(i) * Eigen::Vector2d(2.0, 0.7));
    const double expected =
        0.3 * static_cast<double>(field.at(static_cast<float>(p_grid.x()), static_cast<float>(p_grid.y())));
    if (std::abs(gained(after, i) - expected) > 1e-5) ++different;
  }
  EXPECT_LE(different, 2);
}

TEST_F(Weights, HaveTheSameBitsFromEveryInstructionSet) {
  lidar::BeamPoints beams;
  for (int b = 0; b < 37; ++b) {
    const float bearing = 0.17F * static_cast<float>(b);
    beams.x.push_back(4.0F * std::cos(bearing));
    beams.y.push_back(4.0F * std::sin(bearing));
    beams.weight.push_back(1.0F / static_cast<float>(1 + b % 5));
  }
  const auto weighed = [&](InstructionSet with) {
    filters::ParticleSet after = set;
    RangeWeights ranges(with);
    ScanWeights scans(grid, scan, with);
    for (const double exponent : {1.0, 0.3}) {
      term.exponent = exponent;
      ranges.evaluate(after, headings, term);
      ranges.apply(after);
    }
    scans.evaluate(after, headings, beams, 0.4);
    scans.apply(after);
    return after;
  };
  const filters::ParticleSet portable = weighed(InstructionSet::Portable);
  for (const InstructionSet with : usableInstructionSets()) {
    const filters::ParticleSet same = weighed(with);
    EXPECT_EQ(same.weight, portable.weight) << nameOf(with);
    EXPECT_EQ(same.log_scale, portable.log_scale) << nameOf(with);
  }
}

}  // namespace pos::estimation
