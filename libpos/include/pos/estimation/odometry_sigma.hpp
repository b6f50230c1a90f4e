#pragma once
/// The one place where odometry noise per metre, radian and second becomes the noise of one increment.

#include "pos/estimation/configs.hpp"

namespace pos::estimation {

/// Standard deviations [along (m), across (m), yaw (rad)] of an increment that took `dt` seconds, in the body
/// frame before it. Each is a random walk: variances grow in proportion to distance, turn and time.
Vector<3> incrementSigma(const OdometryNoise& noise, const Pose2& increment, double dt);

}  // namespace pos::estimation
