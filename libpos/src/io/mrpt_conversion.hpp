#pragma once
/// Readings from MRPT observations and back; MRPT's traps end here. Private to io.

#include <mrpt/obs/CObservation.h>

#include <optional>
#include <string>
#include <vector>

#include "pos/core/measurement.hpp"
#include "rawlog_companion.hpp"

namespace mrpt::obs {
class CActionRobotMovement2D;
class CObservation2DRangeScan;
class CObservationBeaconRanges;
class CObservationGPS;
class CObservationIMU;
class CObservationOdometry;
class CObservationRobotPose;
}  // namespace mrpt::obs

namespace pos::io {

// ---- MRPT to pos

/// A sensor label and the tag number it may carry as suffix: "uwb;tag=7".
struct LabelledTag {
  std::string sensor;
  TagId tag = 0;
};
LabelledTag labelledTag(const std::string& label);
std::string labelWithTag(const std::string& sensor, TagId tag);

/// Body rates and specific force, turned into body axes by the sensor's mounting angles. Nothing unless all
/// three gyro and all three accelerometer channels are present.
std::optional<ImuSample> imuSample(const mrpt::obs::CObservationIMU& observation);

/// One per range. A standard deviation of 0 and a tag position of (0,0,0) are MRPT's "not said".
std::vector<BeaconRange> beaconRanges(const mrpt::obs::CObservationBeaconRanges& observation, TagId tag);
/// Why a range is outside what its own observation allows, or nothing.
std::optional<std::string> outsideLimits(const mrpt::obs::CObservationBeaconRanges& observation,
                                         const BeaconRange& range);

/// From the GGA message; nothing without one. The log's covariance is the caller's affair: this one is
/// `defaultCovariance`.
std::optional<GnssFix> gnssFix(const mrpt::obs::CObservationGPS& observation);

/// Nothing for a scan whose pitch changes while it turns (deltaPitch): it is not planar. Beams at zero, at no
/// number or above the sensor's maximum are marked invalid whatever the log says.
std::optional<Scan2D> scan2D(const mrpt::obs::CObservation2DRangeScan& observation);

PoseTruth poseTruth(const mrpt::obs::CObservationRobotPose& observation);
std::optional<PassageFix> passageFix(const mrpt::obs::CObservationRobotPose& observation,
                                     const Companion& companion);

/// The increment of an odometry action; its covariance only where the log's model is Gaussian (MRPT draws
/// random particles for the other one, which would differ from run to run).
OdometryIncrement odometryIncrement(const mrpt::obs::CActionRobotMovement2D& action);
/// Laser scan matching, not wheels.
bool isScanMatching(const mrpt::obs::CActionRobotMovement2D& action);

/// Encoder counters and speeds of an odometry record. Some logs hold uninitialised memory there: the flag is
/// then often neither 0 nor 1, or the numbers are absurd.
template <typename T>
struct Extra {
  std::optional<T> value;
  bool garbage = false;
};
Extra<WheelTicks> ticksOf(const mrpt::obs::CObservationOdometry& observation);
/// Ticks since the previous action.
Extra<WheelTicks> ticksOf(const mrpt::obs::CActionRobotMovement2D& action);
/// Speed ahead for both wheels, and the yaw rate. Sideways speed makes it not representable: no value.
Extra<WheelSpeeds> speedsOf(const mrpt::obs::CObservationOdometry& observation);
Extra<WheelSpeeds> speedsOf(const mrpt::obs::CActionRobotMovement2D& action);

/// The reading with what its companion line adds.
OdometryIncrement completed(OdometryIncrement reading, const Companion& companion);
ImuSample completed(ImuSample reading, const Companion& companion);
BeaconRange completed(BeaconRange reading, const Companion& companion);
GnssFix completed(GnssFix reading, const Companion& companion);
Scan2D completed(Scan2D reading, const Companion& companion);
std::optional<WheelTicks> wheelTicks(const Companion& companion);
std::optional<WheelSpeeds> wheelSpeeds(const Companion& companion);

// ---- pos to MRPT

/// An observation and the line that goes before it, if it needs one.
struct Stored {
  mrpt::obs::CObservation::Ptr carrier;
  std::optional<Companion> companion;
};
/// Everything but odometry and wheels, which need the sensor's accumulated pose. Stamp and label are set.
Stored stored(const Measurement& measurement);
/// `total` is the sensor's accumulated odometry pose.
Stored stored(const WheelTicks& reading, const Pose2& total);
Stored stored(const WheelSpeeds& reading, const Pose2& total);
mrpt::obs::CObservation::Ptr absoluteOdometry(const Pose2& total);

}  // namespace pos::io
