#include "pos/uwb/motion_calibration.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

namespace pos::uwb {
namespace {

constexpr int kFewestPairs = 20;

/// Velocity in body axes and yaw rate, means over dt seconds up to the stamp.
struct Pace {
  Stamp stamp;
  double dt;
  Eigen::Vector2d velocity;
  double yaw_rate;
};

std::vector<Pace> pacesOf(std::span<const TimedPose> poses, double interval) {
  std::vector<Pace> paces;
  std::size_t behind = 0;
  for (const TimedPose& ahead : poses) {
    while (seconds(ahead.stamp - poses[behind].stamp) > interval) ++behind;
    const Pose2& before = poses[behind].pose;
    const double dt = seconds(ahead.stamp - poses[behind].stamp);
    if (dt < 0.5 * interval) continue;
    const double turn = wrapAngle(ahead.pose.yaw - before.yaw);
    const Eigen::Vector2d moved = ahead.pose.translation() - before.translation();
    paces.push_back(
        {ahead.stamp, dt, rotation2(before.yaw + 0.5 * turn).transpose() * moved / dt, turn / dt});
  }
  return paces;
}

/// White acceleration of density q changes the mean over dt of a speed, `lag` seconds on, by
/// q sqrt(lag - dt / 3) in the root mean square.
void addDensities(const std::vector<Pace>& paces, double lag, MotionCalibration& result) {
  double speed = 0.0;
  double rate = 0.0;
  int count = 0;
  std::size_t later = 0;
  for (const Pace& pace : paces) {
    while (later < paces.size() && seconds(paces[later].stamp - pace.stamp) < lag) ++later;
    if (later == paces.size()) break;
    const double apart = seconds(paces[later].stamp - pace.stamp);
    if (apart > 2.0 * lag) continue;  // a hole in the record
    const double time = apart - pace.dt / 3.0;
    speed += std::pow(paces[later].velocity.x() - pace.velocity.x(), 2) / time;
    rate += std::pow(paces[later].yaw_rate - pace.yaw_rate, 2) / time;
    ++count;
  }
  if (count == 0) return;
  result.acceleration_density = std::sqrt(speed / count);
  result.yaw_acceleration_density = std::sqrt(rate / count);
}

}  // namespace

MotionCalibration calibratedMotion(std::span<const TimedPose> poses, double interval, double speed_min) {
  // sideways = forward * t + rate * centre, for t = tan(offset) and the centre
  const std::vector<Pace> paces = pacesOf(poses, interval);
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double squares = 0.0;
  MotionCalibration result;
  for (const Pace& pace : paces) {
    if (std::abs(pace.velocity.x()) < speed_min) continue;
    const Eigen::Vector2d row(pace.velocity.x(), pace.yaw_rate);
    A += row * row.transpose();
    b += pace.velocity.y() * row;
    squares += pace.velocity.y() * pace.velocity.y();
    ++result.samples;
  }
  if (result.samples < kFewestPairs) return {};
  A.diagonal().array() += 1e-9;  // a drive that never turns leaves the centre where the body frame is
  const Eigen::Vector2d x = A.ldlt().solve(b);
  result.course_offset = std::atan(x[0]);
  result.centre_x = x[1];
  result.residual_sigma = std::sqrt(std::max(squares - b.dot(x), 0.0) / result.samples);
  addDensities(paces, 2.0 * interval, result);
  return result;
}

}  // namespace pos::uwb
