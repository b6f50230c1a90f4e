#pragma once
/// Do the wheels change speed as the accelerometers say? The difference of two velocities that share an
/// attitude hides in a filter which follows the wheels; its change within a second does not.

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "pos/core/stamp.hpp"

namespace pos::estimation {

/// Mean velocities over one update (m/s, navigation frame).
struct WheelSlideSample {
  Stamp stamp;
  Eigen::Vector3d wheels = Eigen::Vector3d::Zero();
  /// Of the strapdown alone, without what a filter fed back; only its changes matter.
  Eigen::Vector3d inertial = Eigen::Vector3d::Zero();
  double sigma = 0.0;                                  ///< m/s, of the wheels, each axis
  Eigen::Vector3d fed_back = Eigen::Vector3d::Zero();  ///< all that updates have added to the velocity so far
};

/// A mean of differences wheels minus inertial (m/s), and its variance on each axis.
struct SlideMean {
  Eigen::Vector3d difference = Eigen::Vector3d::Zero();
  Eigen::Vector3d wheels = Eigen::Vector3d::Zero();
  double variance = 0.0;
};

class WheelSlide {
 public:
  void add(const WheelSlideSample& sample);

  /// The differences of the last second scatter no more than the wheels' noise explains (chi-square, 99.9 %).
  /// False while the second is not over. Wheels that shake agree with the accelerometers only now and then,
  /// by chance.
  bool steady() const;
  /// The same of the newest `count` samples; false while there are fewer.
  bool steady(int count) const;

  /// The newest third of the last second's differences less the oldest third. Nothing while the second is not
  /// over.
  std::optional<SlideMean> jump() const;

  /// Keep the oldest third of the last second as what was before a slip.
  void mark();
  /// The newest `count` samples' mean difference less the one that was marked (m/s).
  Eigen::Vector3d sinceMark(int count) const { return newest(count).difference - marked_; }

  /// What updates have added to the velocity within the last second (m/s).
  Eigen::Vector3d fedBack() const;

  /// Over the newest `count` samples, or as many as there are.
  SlideMean newest(int count) const;

  void forget() { samples_.clear(); }

 private:
  bool full() const;

  std::deque<WheelSlideSample> samples_;
  Eigen::Vector3d marked_ = Eigen::Vector3d::Zero();
};

}  // namespace pos::estimation
