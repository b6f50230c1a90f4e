/// Uses the installed headers and libraries; ends with 1 when an answer is wrong.
#include <cmath>
#include <iostream>

#include "pos/core/chi_square.hpp"
#include "pos/core/pose2.hpp"
#include "pos/estimation/configs.hpp"
#include "pos/estimation/estimator.hpp"

int main() {
  const pos::Pose2 T_map_body{1.0, 2.0, 0.5 * pos::kPi};
  const Eigen::Vector2d p_map = T_map_body * Eigen::Vector2d(1.0, 0.0);
  const double gate = pos::chiSquareQuantile(0.95, 2.0);
  const pos::estimation::EstimatorConfig config = pos::estimation::RangeOdometryConfig{};
  std::cout << "point at " << p_map.transpose() << ", 95 % gate " << gate << ", config " << config.index()
            << '\n';
  return std::abs(p_map.y() - 3.0) < 1e-12 && std::abs(gate - 5.991464547) < 1e-6 ? 0 : 1;
}
