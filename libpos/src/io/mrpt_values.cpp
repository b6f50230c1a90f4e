#include "mrpt_values.hpp"

#include <algorithm>
#include <limits>

namespace pos::io {
namespace {

/// 100 ns ticks from 1601-01-01 to 1970-01-01.
constexpr std::int64_t kEpochTicks = 116'444'736'000'000'000;
constexpr std::int64_t kMaxTicks = std::numeric_limits<std::int64_t>::max() / 100;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

}  // namespace

std::optional<Stamp> stampFromMrpt(mrpt::Clock::time_point stamp) {
  const std::int64_t count = stamp.time_since_epoch().count();
  if (count <= 0) return std::nullopt;
  const std::int64_t ticks = count - kEpochTicks;
  if (ticks > kMaxTicks || ticks < -kMaxTicks) return std::nullopt;
  return Stamp{Duration{ticks * 100}};
}

mrpt::Clock::time_point stampToMrpt(Stamp stamp) {
  const std::int64_t nanoseconds = stamp.time_since_epoch().count();
  std::int64_t ticks = nanoseconds / 100;
  const std::int64_t rest = nanoseconds % 100;
  if (rest >= 50) ++ticks;
  if (rest < -50) --ticks;
  return mrpt::Clock::time_point{mrpt::Clock::duration{ticks + kEpochTicks}};
}

Pose2 poseFromMrpt(const mrpt::poses::CPose2D& pose) {
  return {pose.x(), pose.y(), pose.phi()};
}

mrpt::poses::CPose2D poseToMrpt(const Pose2& pose) {
  return {pose.x, pose.y, pose.yaw};
}

Pose3 poseFromMrpt(const mrpt::poses::CPose3D& pose) {
  Pose3 result;
  result.translation = {pose.x(), pose.y(), pose.z()};
  Eigen::Matrix3d R;  // R = rotation matrix, child to parent
  const auto& stored = pose.getRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) R(row, column) = stored(row, column);
  }
  result.rotation = Eigen::Quaterniond(R).normalized();
  return result;
}

mrpt::poses::CPose3D poseToMrpt(const Pose3& pose) {
  const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
  mrpt::math::CMatrixDouble33 rotation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation(row, column) = R(row, column);
  }
  mrpt::math::CMatrixDouble31 translation;
  for (int axis = 0; axis < 3; ++axis) translation(axis, 0) = pose.translation[axis];
  return {rotation, translation};
}

LevelCovariance levelCovariance(const mrpt::poses::CPose3DPDFGaussian& pose) {
  LevelCovariance result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result.position(row, column) = pose.cov(row, column);
  }
  result.yaw_variance = pose.cov(3, 3);
  return result;
}

mrpt::poses::CPose3DPDFGaussian gaussianToMrpt(const Pose3& mean, const LevelCovariance& covariance) {
  mrpt::poses::CPose3DPDFGaussian result;
  result.mean = poseToMrpt(mean);
  result.cov.setZero();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result.cov(row, column) = covariance.position(row, column);
  }
  result.cov(3, 3) = covariance.yaw_variance;
  return result;
}

std::string sanitised(std::string_view text, std::size_t limit) {
  std::string result(text.substr(0, limit));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  if (text.size() > limit) result += "...";
  return result;
}

std::string messageOf(std::string_view what) {
  constexpr std::string_view kMark = "Message:";
  if (const auto mark = what.find(kMark); mark != std::string_view::npos) {
    what.remove_prefix(mark + kMark.size());
    what = what.substr(0, what.find("Location:"));
  }
  what = trimmed(what);
  std::string line = sanitised(what.substr(0, what.find('\n')));
  return std::string(trimmed(line));
}

}  // namespace pos::io
