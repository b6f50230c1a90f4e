#include "pos/estimation/dual_uwb_bank.hpp"

#include <cmath>
#include <string>

namespace pos::estimation {

Matrix<3, 3> spreadAbout(const Pose2& best, const Belief<Pose2>& part, double weight) {
  const Vector<3> apart = minus(part.mean, best);
  Matrix<3, 3> spread = part.covariance;
  spread.topLeftCorner<2, 2>() += apart.head<2>() * apart.head<2>().transpose();
  spread(2, 2) += apart[2] * apart[2];
  return weight * spread;
}

Diagnostics alternative(int number, const Belief<Pose2>& pose) {
  const std::string name = "alternative_" + std::to_string(number) + "_";
  return {{name + "x_m", pose.mean.x, std::sqrt(pose.covariance(0, 0))},
          {name + "y_m", pose.mean.y, std::sqrt(pose.covariance(1, 1))}};
}

}  // namespace pos::estimation
