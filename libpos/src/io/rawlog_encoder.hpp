#pragma once
/// Measurements as MRPT objects in an archive, wherever its bytes go. Private to io.

#include <mrpt/serialization/CArchive.h>

#include <map>
#include <string>

#include "mrpt_conversion.hpp"
#include "pos/core/measurement.hpp"

namespace pos::io {

/// Keeps the sums of the sensors' odometry, so one encoder writes one log from front to back.
class RawlogEncoder {
 public:
  /// Keeps the reference.
  explicit RawlogEncoder(mrpt::serialization::CArchive& archive) : archive_(archive) {}

  /// The measurement has no defect. Throws what the archive throws.
  void put(const Measurement& measurement);

 private:
  /// What the sensor's absolute odometry says after its last record.
  struct Total {
    Pose2 pose;
    Stamp stamp;
    bool referenced = false;
  };

  void put(Stamp stamp, const std::string& label, const Stored& stored);
  void putOdometry(Stamp stamp, const std::string& label, const OdometryIncrement& reading);

  mrpt::serialization::CArchive& archive_;
  std::map<std::string, Total> totals_;
};

}  // namespace pos::io
