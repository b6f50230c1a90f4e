#include "pos/lidar/icp.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "pos/core/config_checks.hpp"
#include "pos/core/square.hpp"

namespace pos::lidar {
namespace {

/// Below this share of the pairs' worth a direction is not held at all.
constexpr double kNothing = 1e-6;

/// r = n'(T q - p) of one pair, J = d r / d [x, y, yaw].
struct Pair {
  double r = 0.0;  // m
  Vector<3> J = Vector<3>::Zero();
  double lever_squared = 0.0;  // m^2, of the point about the second scan's origin
  double square_on = 1.0;      // cos^2 of the beam's incidence: how much of its noise is across the wall
};

using PairPlace = std::vector<Pair>::iterator;

std::vector<Pair> pairsOf(std::span<const WallPoint> first, std::span<const WallPoint> second,
                          const Pose2& T_first_second, const IcpConfig& config) {
  const Eigen::Matrix2d R = rotation2(T_first_second.yaw);
  const double agree = std::cos(config.pair_angle);
  std::vector<Pair> pairs;
  pairs.reserve(second.size());
  for (const WallPoint& point : second) {
    const Eigen::Vector2d lever = R * point.p;
    const Eigen::Vector2d q = lever + T_first_second.translation();
    const Eigen::Vector2d normal = R * point.normal;
    double nearest_squared = square(config.pair_distance);
    const WallPoint* match = nullptr;
    for (const WallPoint& wall : first) {
      const double distance_squared = (wall.p - q).squaredNorm();
      if (distance_squared >= nearest_squared || wall.normal.dot(normal) < agree) continue;
      nearest_squared = distance_squared;
      match = &wall;
    }
    if (match == nullptr) continue;
    const Eigen::Vector2d& n = match->normal;
    const Eigen::Vector2d off = q - match->p;
    if (std::abs(n.x() * off.y() - n.y() * off.x()) > config.pair_along) continue;  // past the wall's end
    pairs.push_back({.r = n.dot(off),
                     .J = {n.x(), n.y(), n.y() * lever.x() - n.x() * lever.y()},
                     .lever_squared = lever.squaredNorm(),
                     .square_on = square(point.normal.dot(point.p)) / point.p.squaredNorm()});
  }
  return pairs;
}

/// Leaves `keep` of the pairs from `begin` to `end`, those with the smallest residuals; where they end.
PairPlace trimmed(PairPlace begin, PairPlace end, double keep) {
  const auto kept = static_cast<std::ptrdiff_t>(std::ceil(keep * static_cast<double>(end - begin)));
  if (kept > 0) {
    std::nth_element(begin, begin + kept - 1, end,
                     [](const Pair& a, const Pair& b) { return std::abs(a.r) < std::abs(b.r); });
  }
  return begin + kept;
}

/// Trims the pairs of either direction by themselves. Trimmed together, the few that hold the weak direction
/// would go first, for it is they that are off.
void trim(std::vector<Pair>& pairs, double keep) {
  Eigen::Matrix2d normals = Eigen::Matrix2d::Zero();
  for (const Pair& pair : pairs) normals += pair.J.head<2>() * pair.J.head<2>().transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(normals);
  const Eigen::Vector2d strong = axes.eigenvectors().col(1);
  const PairPlace split = std::partition(pairs.begin(), pairs.end(), [&strong](const Pair& pair) {
    return std::abs(strong.dot(pair.J.head<2>())) > std::sqrt(0.5);
  });
  const PairPlace strong_end = trimmed(pairs.begin(), split, keep);
  const PairPlace weak_end = trimmed(split, pairs.end(), keep);
  pairs.erase(std::move(split, weak_end, strong_end), pairs.end());
}

/// Sum of J'J, J'r and what they say of each direction. The turn is measured at the points' r.m.s. distance,
/// so that all three unknowns are metres.
struct Solution {
  Matrix<3, 3> A = Matrix<3, 3>::Zero();
  Matrix<3, 3> B = Matrix<3, 3>::Zero();  // the same, each pair by its square_on
  Vector<3> step = Vector<3>::Zero();
  Matrix<3, 3> inverse = Matrix<3, 3>::Zero();   // of A, without directions that are not held at all
  Matrix<3, 3> not_held = Matrix<3, 3>::Zero();  // m^2: their variance
};

Solution solved(const std::vector<Pair>& pairs, double pair_distance) {
  Solution solution;
  Vector<3> g = Vector<3>::Zero();
  double lever_squared = 0.0;
  for (const Pair& pair : pairs) {
    solution.A += pair.J * pair.J.transpose();
    solution.B += pair.square_on * pair.J * pair.J.transpose();
    g += pair.r * pair.J;
    lever_squared += pair.lever_squared;
  }
  const auto count = static_cast<double>(pairs.size());
  const Vector<3> unit(1.0, 1.0, 1.0 / std::sqrt(std::max(lever_squared / count, 1e-12)));
  const Eigen::SelfAdjointEigenSolver<Matrix<3, 3>> axes(unit.asDiagonal() * solution.A * unit.asDiagonal());
  for (int k = 0; k < 3; ++k) {
    const double value = axes.eigenvalues()[k];
    const Vector<3> axis = unit.asDiagonal() * axes.eigenvectors().col(k);
    if (value > kNothing * count) {
      solution.inverse += axis * axis.transpose() / value;
      solution.step -= axis * (axis.dot(g) / value);
    } else {
      solution.not_held += square(pair_distance) * axis * axis.transpose();
    }
  }
  return solution;
}

/// Fills in what is known of the translation.
void judge(IcpResult& result, const Solution& solution, const IcpConfig& config) {
  const Matrix<3, 3>& A = solution.A;
  result.information = A;
  // Points are off along their beams; both sweeps' are.
  result.covariance = 2.0 * square(config.sigma) * (solution.inverse * solution.B * solution.inverse);
  result.covariance += solution.not_held;
  const Eigen::Vector2d coupling = A.topRightCorner<2, 1>();
  Eigen::Matrix2d alone = A.topLeftCorner<2, 2>();
  if (A(2, 2) > 0.0) alone -= coupling * coupling.transpose() / A(2, 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(alone);
  result.shares = axes.eigenvalues().cwiseMax(0.0) / static_cast<double>(result.pairs);
  result.weak_axis = axes.eigenvectors().col(0);
  result.weak = !(result.shares[0] >= config.weak_share);
}

}  // namespace

IcpConfig validated(IcpConfig config) {
  require(config.keep > 0.0 && config.keep <= 1.0, "keep", "above 0, at most 1");
  requirePositive(config.pair_distance, "pair_distance", "m");
  requirePositive(config.pair_along, "pair_along", "m");
  requirePositive(config.pair_angle, "pair_angle", "rad");
  require(config.iterations_max >= 1, "iterations_max", ">= 1");
  requirePositive(config.step_small, "step_small", "m and rad");
  require(config.pairs_min >= 3, "pairs_min", ">= 3");
  requirePositive(config.sigma, "sigma", "m");
  requireShare(config.weak_share, "weak_share");
  return config;
}

IcpResult registered(std::span<const WallPoint> first, std::span<const WallPoint> second, const Pose2& guess,
                     const IcpConfig& config) {
  IcpResult result{.T_first_second = guess, .end = IcpEnd::Wandering};
  while (result.end == IcpEnd::Wandering && result.iterations < config.iterations_max) {
    std::vector<Pair> pairs = pairsOf(first, second, result.T_first_second, config);
    trim(pairs, config.keep);
    if (pairs.size() < static_cast<std::size_t>(config.pairs_min)) {
      return {.T_first_second = guess, .end = IcpEnd::TooFewPairs, .pairs = static_cast<int>(pairs.size())};
    }
    ++result.iterations;
    double squares = 0.0;
    for (const Pair& pair : pairs) squares += square(pair.r);
    result.pairs = static_cast<int>(pairs.size());
    result.rms = std::sqrt(squares / static_cast<double>(pairs.size()));
    const Solution solution = solved(pairs, config.pair_distance);
    judge(result, solution, config);
    result.T_first_second = plus(result.T_first_second, solution.step);
    if (solution.step.cwiseAbs().maxCoeff() < config.step_small) result.end = IcpEnd::Converged;
  }
  return result;
}

}  // namespace pos::lidar
