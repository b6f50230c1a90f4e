#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

#include "pos/core/square.hpp"
#include "pos/estimation/inertial_filters.hpp"

namespace pos::estimation {
namespace {

constexpr int n = 15;
constexpr double kBeta = 2.0;
constexpr double kFloor = 1e-12;  // of the covariance's eigenvalues, where it is none any more
constexpr int kMeanRounds = 5;
constexpr double kMeanFound = 1e-12;

}  // namespace

ManifoldUkf::ManifoldUkf(const Belief<EskfState>& start, const ins::EskfProcess& process, double spread)
    : belief_(start), process_(process) {
  const double scaled = square(spread) * n;  // n + lambda, with kappa = 0
  weights_.first_mean = 1.0 - n / scaled;
  weights_.first_covariance = weights_.first_mean + 1.0 - square(spread) + kBeta;
  weights_.other = 0.5 / scaled;
  weights_.scale = std::sqrt(scaled);
}

Matrix<15, 15> ManifoldUkf::root() const {
  const Eigen::LLT<Matrix<15, 15>> factor(belief_.covariance);
  if (factor.info() == Eigen::Success) return factor.matrixL();
  const Eigen::SelfAdjointEigenSolver<Matrix<15, 15>> eigen(belief_.covariance);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(kFloor).cwiseSqrt().asDiagonal();
}

void ManifoldUkf::propagate(const ins::ImuIncrement& raw) {
  if (raw.dt == 0.0) return;
  const Vector<15> half = 0.5 * ins::processNoise(process_, raw.dt);
  belief_.covariance.diagonal() += half;
  const Matrix<15, 15> L = weights_.scale * root();
  std::array<EskfState, 2 * n + 1> points;
  points[0] = ins::steppedMean(belief_.mean, raw, process_.gravity);
  for (int i = 0; i < n; ++i) {
    const Vector<15> d = L.col(i);
    points[static_cast<std::size_t>(1 + i)] = ins::steppedMean(plus(belief_.mean, d), raw, process_.gravity);
    points[static_cast<std::size_t>(1 + n + i)] =
        ins::steppedMean(plus(belief_.mean, Vector<15>(-d)), raw, process_.gravity);
  }
  // The mean's weights sum to one: differences to the middle point carry all of it.
  EskfState mean = points[0];
  Eigen::Matrix<double, 15, 2 * n + 1> e;
  for (int round = 0; round < kMeanRounds; ++round) {
    for (int i = 0; i <= 2 * n; ++i) e.col(i) = minus(points[static_cast<std::size_t>(i)], mean);
    const Vector<15> shift =
        weights_.other * (e.rightCols(2 * n).colwise() - e.col(0)).rowwise().sum() + e.col(0);
    mean = plus(mean, shift);
    if (shift.norm() < kMeanFound) break;
  }
  for (int i = 0; i <= 2 * n; ++i) e.col(i) = minus(points[static_cast<std::size_t>(i)], mean);
  belief_.mean = mean;
  belief_.covariance = weights_.first_covariance * e.col(0) * e.col(0).transpose();
  belief_.covariance += weights_.other * e.rightCols(2 * n) * e.rightCols(2 * n).transpose();
  filters::symmetrise(belief_.covariance);
  belief_.covariance.diagonal() += half;
}

void ManifoldUkf::coast(double dt) {
  belief_.mean.p_map += dt * belief_.mean.v_map;
  ins::carry(belief_.covariance, coasting(dt), coastingNoise(dt));
}

SequentialCorrection::Expected ManifoldUkf::expected(const RangeLink& link) const {
  const auto cloud = seenThrough<1>([&](const EskfState& x) {
    const RangeSeen seen = seenRange(x, link.lever, link.anchor_map, link.range);
    return filters::Innovation<EskfState, 1>{Vector<1>(seen.row.nu), {}};
  });
  return {cloud.nu[0], cloud.spread(0, 0)};
}

filters::Correction<1> ManifoldUkf::take(const RangeLink& link, double R) {
  const auto cloud = seenThrough<1>([&](const EskfState& x) {
    const RangeSeen seen = seenRange(x, link.lever, link.anchor_map, link.range);
    return filters::Innovation<EskfState, 1>{Vector<1>(seen.row.nu), {}};
  });
  return correctWith<1>(cloud, Matrix<1, 1>(R), {});
}

}  // namespace pos::estimation
