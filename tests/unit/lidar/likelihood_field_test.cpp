#include "pos/lidar/likelihood_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pos/core/error.hpp"
#include "pos/core/random.hpp"

namespace pos::lidar {
namespace {

constexpr int kColumns = 37;
constexpr int kRows = 23;
constexpr double kResolution = 0.2;
constexpr double kXMin = -3.1;
constexpr double kYMin = 1.7;

std::vector<std::uint8_t> scatteredObstacles() {
  RandomStream random(12, 5);
  std::vector<std::uint8_t> occupancy(kColumns * kRows, 0);
  for (std::uint8_t& cell : occupancy) {
    const double u = random.uniform();
    if (u < 0.02) cell = 100;
    if (u > 0.7) cell = 255;  // never seen
    if (u > 0.5 && u < 0.52) cell = 64;
  }
  return occupancy;
}

Cells cells(const std::vector<std::uint8_t>& occupancy) {
  return {.columns = kColumns,
          .rows = kRows,
          .resolution = kResolution,
          .x_min = kXMin,
          .y_min = kYMin,
          .occupancy = occupancy};
}

/// Nearest occupied cell by looking at every one.
double bruteDistance(const std::vector<std::uint8_t>& occupancy, int column, int row, double reach) {
  double best = reach;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      const std::uint8_t percent = occupancy[static_cast<std::size_t>(r * kColumns + c)];
      if (percent < 65 || percent > 100) continue;
      best = std::min(best, kResolution * std::hypot(c - column, r - row));
    }
  }
  return best;
}

double bruteLogLikelihood(const std::vector<std::uint8_t>& occupancy, const BeamModel& model, double x,
                          double y) {
  const int column = static_cast<int>(std::floor((x - kXMin) / kResolution));
  const int row = static_cast<int>(std::floor((y - kYMin) / kResolution));
  if (column < 0 || row < 0 || column >= kColumns || row >= kRows) return std::log(model.outlier_probability);
  const double d = bruteDistance(occupancy, column, row, model.distance_max) / model.sigma;
  return std::log((1.0 - model.outlier_probability) * std::exp(-0.5 * d * d) + model.outlier_probability);
}

}  // namespace

TEST(ObstacleDistances, AgreeWithBruteForceInEveryCell) {
  const std::vector<std::uint8_t> occupancy = scatteredObstacles();
  const std::vector<float> distances = obstacleDistances(cells(occupancy), 1.5);
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      EXPECT_NEAR(distances[static_cast<std::size_t>(row * kColumns + column)],
                  bruteDistance(occupancy, column, row, 1.5), 1e-5)
          << column << ", " << row;
    }
  }
}

TEST(ObstacleDistances, AreAllFarWhereNothingIsOccupied) {
  const std::vector<std::uint8_t> occupancy(kColumns * kRows, 255);
  const std::vector<float> distances = obstacleDistances(cells(occupancy), 0.8);
  EXPECT_EQ(std::count(distances.begin(), distances.end(), 0.8F), kColumns * kRows);
}

TEST(LikelihoodField, ScoresAgreeWithBruteForce) {
  const std::vector<std::uint8_t> occupancy = scatteredObstacles();
  const BeamModel model{.sigma = 0.15, .outlier_probability = 0.25, .distance_max = 1.0};
  const LikelihoodField field(cells(occupancy), model);
  RandomStream random(3, 3);
  std::vector<float> x, y, c, s;
  BeamPoints beams;
  for (int b = 0; b < 150; ++b) {  // more than one chunk
    const double bearing = random.uniform(-3.0, 3.0);
    const double range = random.uniform(0.2, 4.0);
    beams.x.push_back(static_cast<float>(range * std::cos(bearing)));
    beams.y.push_back(static_cast<float>(range * std::sin(bearing)));
    beams.weight.push_back(static_cast<float>(random.uniform(0.1, 1.0)));
  }
  for (int i = 0; i < 40; ++i) {
    const double yaw = random.uniform(-3.1, 3.1);
    x.push_back(static_cast<float>(random.uniform(-4.0, 5.0)));
    y.push_back(static_cast<float>(random.uniform(1.0, 7.0)));
    c.push_back(static_cast<float>(std::cos(yaw)));
    s.push_back(static_cast<float>(std::sin(yaw)));
  }
  std::vector<float> totals(x.size(), 10.0F);  // the scores are added to what is there
  field.addScores({x, y, c, s}, beams, totals);
  for (std::size_t i = 0; i < x.size(); ++i) {
    double expected = 10.0;
    double slack = 1e-4;  // float; the table adds its bound below
    for (std::size_t b = 0; b < beams.size(); ++b) {
      const double px = static_cast<double>(x[i]) + static_cast<double>(c[i]) * beams.x[b] -
                        static_cast<double>(s[i]) * beams.y[b];
      const double py = static_cast<double>(y[i]) + static_cast<double>(s[i]) * beams.x[b] +
                        static_cast<double>(c[i]) * beams.y[b];
      slack += beams.weight[b] * field.errorBound();
      expected += beams.weight[b] * bruteLogLikelihood(occupancy, model, px, py);
      // a point within float's rounding of a cell border may fall to either side
      const double u = (px - kXMin) / kResolution;
      const double v = (py - kYMin) / kResolution;
      if (std::min(std::abs(u - std::round(u)), std::abs(v - std::round(v))) < 1e-4)
        slack += beams.weight[b] * 1.4;
    }
    EXPECT_NEAR(totals[i], expected, slack) << i;
  }
}

TEST(LikelihoodField, KnowsItsCellsAndTheOutside) {
  std::vector<std::uint8_t> occupancy(kColumns * kRows, 0);
  occupancy[5 * kColumns + 7] = 100;
  const BeamModel model{.sigma = 0.2, .outlier_probability = 0.1, .distance_max = 2.0};
  const LikelihoodField field(cells(occupancy), model);
  const auto x = static_cast<float>(kXMin + 7.5 * kResolution);
  const auto y = static_cast<float>(kYMin + 5.5 * kResolution);
  EXPECT_NEAR(field.at(x, y), 0.0, field.errorBound() + 1e-6);
  EXPECT_NEAR(field.at(x + 0.2F, y), std::log(0.9 * std::exp(-0.5) + 0.1), field.errorBound() + 1e-6);
  EXPECT_NEAR(field.at(x, y - 0.4F), std::log(0.9 * std::exp(-2.0) + 0.1), field.errorBound() + 1e-6);
  for (const auto& [u, v] :
       {std::pair(-100.0F, y), std::pair(100.0F, y), std::pair(x, -100.0F), std::pair(x, 100.0F)}) {
    EXPECT_NEAR(field.at(u, v), std::log(0.1), field.errorBound() + 1e-6);
  }
}

TEST(LikelihoodField, RefusesCellsThatDoNotMatchTheirSize) {
  const std::vector<std::uint8_t> occupancy(10, 0);
  EXPECT_THROW(LikelihoodField(cells(occupancy), BeamModel{}), ContractError);
}

}  // namespace pos::lidar
