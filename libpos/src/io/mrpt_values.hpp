#pragma once
/// Stamps, poses, covariances and messages between MRPT and pos. Private to io.

#include <mrpt/core/Clock.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "pos/core/pose2.hpp"
#include "pos/core/pose3.hpp"
#include "pos/core/stamp.hpp"

namespace pos::io {

/// MRPT counts 100 ns ticks since 1601-01-01 UTC; tick 0 is its INVALID_TIMESTAMP. Nothing for that one and
/// for stamps outside 1678..2262, which nanoseconds since 1970 cannot hold (they come from damaged fields).
std::optional<Stamp> stampFromMrpt(mrpt::Clock::time_point stamp);
/// Rounded to the nearest 100 ns.
mrpt::Clock::time_point stampToMrpt(Stamp stamp);

Pose2 poseFromMrpt(const mrpt::poses::CPose2D& pose);
mrpt::poses::CPose2D poseToMrpt(const Pose2& pose);
Pose3 poseFromMrpt(const mrpt::poses::CPose3D& pose);
mrpt::poses::CPose3D poseToMrpt(const Pose3& pose);

/// What an MRPT 6-D Gaussian says of a level body: position covariance and variance of yaw. MRPT orders the
/// pose covariance [x y z yaw pitch roll], so yaw is element 3, not 5.
struct LevelCovariance {
  Matrix<3, 3> position = Matrix<3, 3>::Zero();  ///< m^2
  double yaw_variance = 0.0;                     ///< rad^2
};
LevelCovariance levelCovariance(const mrpt::poses::CPose3DPDFGaussian& pose);
mrpt::poses::CPose3DPDFGaussian gaussianToMrpt(const Pose3& mean, const LevelCovariance& covariance);

/// The message of an MRPT exception without its call stack, on one line, with every byte that is not plain
/// printable ASCII shown as '?': a damaged class name is echoed raw by MRPT and could garble a terminal.
std::string messageOf(std::string_view what);
/// At most `limit` characters of `text`, cleaned the same way.
std::string sanitised(std::string_view text, std::size_t limit = 200);

/// A C++ bool read from a file by MRPT may hold any byte; looking at it as a bool would be undefined.
enum class Flag { No, Yes, Garbage };
inline Flag flagOf(const bool& stored) {
  unsigned char byte = 0;
  std::memcpy(&byte, &stored, 1);
  if (byte > 1) return Flag::Garbage;
  return byte == 1 ? Flag::Yes : Flag::No;
}

}  // namespace pos::io
