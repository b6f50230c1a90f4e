#include "pos/eval/alignment.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <string>

#include "pos/core/error.hpp"

namespace pos::eval {

namespace {

using Points = Eigen::Matrix3Xd;

/// Below this spread (m) a set of positions has no direction.
constexpr double kLeastSpread = 0.05;

[[noreturn]] void throwTooStill(AlignmentMode mode, const char* what, const char* suggestion) {
  throw DataError(
      Complaint{.what = what, .key = "alignment", .got = std::string(name(mode)), .suggestion = suggestion});
}

void requireCoordinates(AlignmentMode mode, const Truth& truth) {
  const bool needs_yaw = mode == AlignmentMode::Origin;
  const bool needs_z = mode == AlignmentMode::Se3;
  if (needs_yaw && !truth.has_yaw) {
    throw UsageError(
        Complaint{.what = "alignment by the first pose needs a heading in the truth, which has none",
                  .key = "alignment",
                  .got = std::string(name(mode)),
                  .suggestion = "se2"});
  }
  if (needs_z && !truth.has_z) {
    throw UsageError(Complaint{.what = "alignment in space needs a height in the truth, which has none",
                               .key = "alignment",
                               .got = std::string(name(mode)),
                               .suggestion = "se2"});
  }
}

Pose3 originTransform(const MatchedPose& first, const Truth& truth) {
  const Pose3& estimate = first.estimate.T_map_body;
  if (truth.has_z) return first.T_map_truth * inverse(estimate);
  return Pose3::fromPlanar(first.T_map_truth.planar() * inverse(estimate.planar()));
}

/// Rotation about the vertical and shift that carry `from` onto `to`; equal weights.
Pose3 headingTransform(const Points& from, const Points& to, AlignmentMode mode) {
  const Eigen::Vector3d from_mean = from.rowwise().mean();
  const Eigen::Vector3d to_mean = to.rowwise().mean();
  const Eigen::Matrix2Xd a = (from.colwise() - from_mean).topRows<2>();
  const Eigen::Matrix2Xd b = (to.colwise() - to_mean).topRows<2>();
  const double n = static_cast<double>(from.cols());
  if (std::sqrt(std::min(a.squaredNorm(), b.squaredNorm()) / n) < kLeastSpread) {
    throwTooStill(mode, "the vehicle does not move enough for its path to show a rotation", "none or origin");
  }
  const double dot = a.cwiseProduct(b).sum();
  const double cross = a.row(0).dot(b.row(1)) - a.row(1).dot(b.row(0));
  Pose3 T = Pose3::fromXyzYawPitchRoll(0.0, 0.0, 0.0, std::atan2(cross, dot), 0.0, 0.0);
  T.translation = to_mean - T.rotation * from_mean;
  return T;
}

/// Umeyama (1991), equations 39-42, without the scale.
Pose3 spatialTransform(const Points& from, const Points& to) {
  const Eigen::Vector3d from_mean = from.rowwise().mean();
  const Eigen::Vector3d to_mean = to.rowwise().mean();
  const Eigen::Matrix3d sigma =
      (to.colwise() - to_mean) * (from.colwise() - from_mean).transpose() / static_cast<double>(from.cols());
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sigma, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (std::sqrt(svd.singularValues()(1)) < kLeastSpread) {
    throwTooStill(AlignmentMode::Se3, "the path is a point or a straight line, which leaves a rotation open",
                  "posyaw");
  }
  Eigen::Vector3d s = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) s.z() = -1.0;
  Pose3 T;
  T.rotation = Eigen::Quaterniond(svd.matrixU() * s.asDiagonal() * svd.matrixV().transpose());
  T.translation = to_mean - T.rotation * from_mean;
  return T;
}

}  // namespace

std::string_view name(AlignmentMode mode) {
  switch (mode) {
    case AlignmentMode::None:
      return "none";
    case AlignmentMode::Origin:
      return "origin";
    case AlignmentMode::Se2:
      return "se2";
    case AlignmentMode::Se3:
      return "se3";
    case AlignmentMode::PosYaw:
      return "posyaw";
  }
  return "none";
}

Alignment alignment(const std::vector<MatchedPose>& pairs, AlignmentMode mode, const Truth& truth) {
  Alignment result{mode, {}};
  requireCoordinates(mode, truth);
  if (pairs.empty() || mode == AlignmentMode::None) return result;
  if (mode == AlignmentMode::Origin) {
    result.T_truth_estimate = originTransform(pairs.front(), truth);
    return result;
  }
  Points from(3, static_cast<Eigen::Index>(pairs.size()));
  Points to(3, from.cols());
  for (Eigen::Index i = 0; i < from.cols(); ++i) {
    const MatchedPose& pair = pairs[static_cast<std::size_t>(i)];
    from.col(i) = pair.estimate.T_map_body.translation;
    to.col(i) = pair.T_map_truth.translation;
  }
  const bool planar = mode == AlignmentMode::Se2 || (mode == AlignmentMode::PosYaw && !truth.has_z);
  result.T_truth_estimate =
      mode == AlignmentMode::Se3 ? spatialTransform(from, to) : headingTransform(from, to, mode);
  if (planar) result.T_truth_estimate.translation.z() = 0.0;
  return result;
}

Estimate aligned(const Estimate& estimate, const Alignment& alignment) {
  if (alignment.mode == AlignmentMode::None) return estimate;
  Estimate moved = estimate;
  moved.T_map_body = alignment.T_truth_estimate * estimate.T_map_body;
  Matrix<6, 6> J = Matrix<6, 6>::Identity();
  J.topLeftCorner<3, 3>() = alignment.T_truth_estimate.rotation.toRotationMatrix();
  moved.covariance = J * estimate.covariance * J.transpose();
  return moved;
}

}  // namespace pos::eval
