#include "pos/core/measurement.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace pos {
namespace {

using Defect = std::optional<std::string>;

bool finite(double value) {
  return std::isfinite(value);
}
bool finite(const Pose2& pose) {
  return finite(pose.x) && finite(pose.y) && finite(pose.yaw);
}
bool finite(const Pose3& pose) {
  return pose.translation.allFinite() && pose.rotation.coeffs().allFinite();
}

bool isCovariance(const Matrix<3, 3>& P) {
  if (!P.allFinite() || !P.isApprox(P.transpose(), 1e-6)) return false;
  return Eigen::SelfAdjointEigenSolver<Matrix<3, 3>>(P).eigenvalues().minCoeff() >= -1e-9 * P.norm();
}

struct FindDefect {
  Defect operator()(const OdometryIncrement& r) const {
    if (!finite(r.increment)) return "odometry increment is not a finite number";
    if (r.covariance && !isCovariance(*r.covariance))
      return "odometry covariance is not positive semi-definite";
    return {};
  }
  Defect operator()(const WheelSpeeds& r) const {
    if (!finite(r.left) || !finite(r.right)) return "wheel speed is not a finite number";
    if (r.yaw_rate && !finite(*r.yaw_rate)) return "yaw rate is not a finite number";
    return {};
  }
  Defect operator()(const WheelTicks&) const { return {}; }
  Defect operator()(const ImuSample& r) const {
    if (!r.angular.allFinite() || !r.linear.allFinite()) return "IMU reading is not a finite number";
    if (r.kind == ImuSample::Kind::Increments && !r.interval) return "IMU increments without their interval";
    return {};
  }
  Defect operator()(const BeaconRange& r) const {
    if (!finite(r.range)) return "range is not a finite number";
    if (r.range <= 0.0) return "range is zero or negative";
    if (r.sigma && !(*r.sigma > 0.0 && finite(*r.sigma))) return "range sigma is not a positive number";
    if (r.tag_body && !r.tag_body->allFinite()) return "tag position is not a finite number";
    return {};
  }
  Defect operator()(const GnssFix& r) const {
    if (!finite(r.latitude) || !finite(r.longitude) || !finite(r.altitude))
      return "fix is not a finite number";
    if (std::abs(r.latitude) > 0.5 * kPi || std::abs(r.longitude) > 2.0 * kPi)
      return "fix is not on the Earth";
    if (!isCovariance(r.covariance_enu)) return "fix covariance is not positive semi-definite";
    return {};
  }
  Defect operator()(const Scan2D& r) const {
    if (r.ranges.empty()) return "scan has no beams";
    if (r.ranges.size() != r.valid.size()) return "scan has different numbers of ranges and validity marks";
    if (!finite(r.T_body_sensor) || !finite(r.angle_first) || !finite(r.angle_step))
      return "scan geometry is not finite";
    for (std::size_t i = 0; i < r.ranges.size(); ++i) {
      if (r.valid[i] != 0 && !(std::isfinite(r.ranges[i]) && r.ranges[i] >= 0.0F))
        return "scan has a bad range marked valid";
    }
    return {};
  }
  Defect operator()(const PoseTruth& r) const {
    return finite(r.T_map_body) ? Defect{} : Defect{"truth pose is not a finite number"};
  }
  Defect operator()(const PassageFix& r) const {
    if (!r.p_map.allFinite()) return "passage position is not a finite number";
    if (!r.p_body.allFinite()) return "passage mount is not a finite number";
    if (!isCovariance(r.covariance)) return "passage covariance is not positive semi-definite";
    if (r.yaw && !finite(*r.yaw)) return "passage heading is not a finite number";
    return {};
  }
};

}  // namespace

const std::vector<std::string_view>& readingNames() {
  static const std::vector<std::string_view> kNames{
      "odometry", "wheel_speeds", "wheel_ticks", "imu", "range", "gnss", "scan", "truth", "passage"};
  return kNames;
}

std::string_view readingName(const Reading& reading) {
  return readingNames()[reading.index()];
}

std::optional<std::string> defect(const Measurement& measurement) {
  return std::visit(FindDefect{}, measurement.reading);
}

}  // namespace pos
