#include "rawlog_intake.hpp"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBeaconRanges.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <utility>

#include "mrpt_values.hpp"

namespace pos::io {
namespace {

using namespace mrpt::obs;
using mrpt::serialization::CSerializable;

std::string labelOr(const std::string& label, const char* reading) {
  return label.empty() ? reading : label;
}

/// Null for other objects. The commonest classes are told without a dynamic_cast (bench/rawlog_read).
CObservation* asObservation(CSerializable& object) {
  if (is<CObservationIMU>(object) || is<CObservationBeaconRanges>(object)) {
    return static_cast<CObservation*>(&object);
  }
  return dynamic_cast<CObservation*>(&object);
}

}  // namespace

std::optional<Measurement> RawlogIntake::pop() {
  if (head_ == queue_.size()) return std::nullopt;
  Queued& queued = queue_[head_++];
  frame_ = queued.frame;
  std::optional<Measurement> result(std::move(queued.measurement));
  if (head_ == queue_.size()) {
    queue_.clear();
    head_ = 0;
  }
  return result;
}

LogFormat RawlogIntake::format() const {
  const bool framed = frames_ > 0 || actions_seen_;
  if (framed && observations_ > 0) return LogFormat::Mixed;
  if (framed) return LogFormat::ActionsAndFrames;
  return observations_ > 0 ? LogFormat::Observations : LogFormat::Unknown;
}

void RawlogIntake::deliver(Measurement measurement, Frame frame) {
  if (const auto reason = defect(measurement)) {
    refuse(*reason);
    return;
  }
  queue_.push_back({std::move(measurement), frame});
}

std::optional<Stamp> RawlogIntake::stampOf(mrpt::Clock::time_point stamp) const {
  if (stamp >= opened_ && stamp <= mrpt::Clock::now()) return std::nullopt;
  return stampFromMrpt(stamp);
}

const Companion* RawlogIntake::companionFor(std::string_view kind) const {
  return companion_ && companion_->kind() == kind ? &*companion_ : nullptr;
}

void RawlogIntake::take(CSerializable* object) {
  if (object == nullptr) {
    skip("nullptr");
  } else if (auto* observation = asObservation(*object); observation != nullptr) {
    const Frame index = frames_ == 0 && !actions_seen_ ? Frame{observations_} : Frame{};
    if (takeCompanion(*observation)) return;
    ++observations_;
    takeObservation(*observation, std::nullopt, index);
  } else if (is<CSensoryFrame>(*object)) {
    takeFrame(static_cast<CSensoryFrame&>(*object));
  } else {
    skip(classOf(*object));
  }
}

bool RawlogIntake::takeCompanion(CObservation& observation) {
  if (!is<CObservationComment>(observation)) return false;
  auto found = Companion::fromText(static_cast<CObservationComment&>(observation).text);
  if (!found) return false;
  if (companion_) refuse("companion line without its observation");
  companion_ = std::move(found);
  companion_stamp_ = observation.timestamp;
  return true;
}

void RawlogIntake::takeMovement(const CActionRobotMovement2D& movement, Stamp stamp, Frame frame) {
  OdometryIncrement reading = odometryIncrement(movement);
  if (last_frame_stamp_ && stamp > *last_frame_stamp_) reading.interval = stamp - *last_frame_stamp_;
  if (isScanMatching(movement)) {
    deliver({stamp, "scan_matching", reading}, frame);
    return;
  }
  deliver({stamp, "odometry", reading}, frame);
  auto ticks = ticksOf(movement);
  if (ticks.value) {
    action_ticks_.left += ticks.value->left;
    action_ticks_.right += ticks.value->right;
    ticks.value = action_ticks_;
  }
  takeExtra(ticks, "encoder counters", ticks_distrusted_, "odometry", stamp, frame);
  takeExtra(speedsOf(movement), "odometry velocities", speeds_distrusted_, "odometry", stamp, frame);
}

template <typename T>
void RawlogIntake::takeExtra(const Extra<T>& extra, const char* what, bool& distrusted,
                             const std::string& label, Stamp stamp, Frame frame) {
  distrusted = distrusted || extra.garbage;
  if (extra.garbage) {
    refuse(std::string(what) + " that are not credible (uninitialised fields)");
  } else if (extra.value && distrusted) {
    refuse(std::string(what) + " of a log that already held garbage there");
  } else if (extra.value) {
    deliver({stamp, label, *extra.value}, frame);
  }
}

template <typename T>
void RawlogIntake::takeSimple(std::optional<T> reading, const char* unusable, CObservation& observation,
                              Stamp stamp, Frame frame) {
  if (!reading) {
    skip(classOf(observation) + unusable);
    return;
  }
  Measurement measurement{stamp, std::move(observation.sensorLabel), std::move(*reading)};
  const std::string_view name = readingName(measurement.reading);
  if (measurement.sensor.empty()) measurement.sensor = name;
  if (const Companion* extra = companionFor(name)) {
    measurement.reading = completed(std::get<T>(std::move(measurement.reading)), *extra);
  }
  deliver(std::move(measurement), frame);
}

void RawlogIntake::takeObservation(CObservation& observation, std::optional<Stamp> fallback, Frame frame) {
  const auto own = stampOf(observation.timestamp);
  const auto stamp = own ? own : fallback;
  if (companion_ && companion_stamp_ != observation.timestamp) {
    refuse("companion line without its observation");
    companion_.reset();
  }
  if (is<CObservationComment>(observation)) {
    skip(classOf(observation));
  } else if (!stamp) {
    refuse("no time stamp");
  } else if (is<CObservationIMU>(observation)) {
    takeSimple(imuSample(static_cast<CObservationIMU&>(observation)),
               " without all six gyro and accelerometer channels", observation, *stamp, frame);
  } else if (is<CObservationBeaconRanges>(observation)) {
    takeRanges(observation, *stamp, frame);
  } else if (is<CObservationOdometry>(observation)) {
    takeOdometry(observation, *stamp, frame);
  } else if (is<CObservation2DRangeScan>(observation)) {
    takeSimple(scan2D(static_cast<CObservation2DRangeScan&>(observation)), " with changing pitch",
               observation, *stamp, frame);
  } else if (is<CObservationGPS>(observation)) {
    takeSimple(gnssFix(static_cast<CObservationGPS&>(observation)), " without a GGA message", observation,
               *stamp, frame);
  } else if (is<CObservationRobotPose>(observation)) {
    takePose(observation, *stamp, frame);
  } else {
    skip(classOf(observation));
  }
  companion_.reset();
}

void RawlogIntake::takeRanges(CObservation& observation, Stamp stamp, Frame frame) {
  const auto& ranges = static_cast<CObservationBeaconRanges&>(observation);
  const LabelledTag from = labelledTag(labelOr(observation.sensorLabel, "range"));
  const Companion* extra = companionFor("range");
  for (BeaconRange& range : beaconRanges(ranges, from.tag)) {
    if (const auto reason = outsideLimits(ranges, range)) {
      refuse(*reason);
    } else {
      deliver({stamp, from.sensor, extra != nullptr ? completed(range, *extra) : range}, frame);
    }
  }
}

void RawlogIntake::takeOdometry(CObservation& observation, Stamp stamp, Frame frame) {
  auto& odometry = static_cast<CObservationOdometry&>(observation);
  if (const Companion* ticks = companionFor("wheel_ticks")) {
    if (const auto reading = wheelTicks(*ticks)) {
      deliver({stamp, labelOr(odometry.sensorLabel, "wheel_ticks"), *reading}, frame);
      return;
    }
  }
  if (const Companion* speeds = companionFor("wheel_speeds")) {
    if (const auto reading = wheelSpeeds(*speeds)) {
      deliver({stamp, labelOr(odometry.sensorLabel, "wheel_speeds"), *reading}, frame);
      return;
    }
  }
  const std::string label = labelOr(odometry.sensorLabel, "odometry");
  const OdometryReference now{poseFromMrpt(odometry.odometry), stamp};
  const auto [found, first] = odometry_.try_emplace(label, now);
  OdometryIncrement reading;
  reading.increment = inverse(found->second.pose) * now.pose;
  if (defect({stamp, label, reading})) {
    refuse("odometry pose is not a finite number");
    if (first) odometry_.erase(found);
  } else if (first) {
    ++tally_.references;
  } else {
    if (stamp > found->second.stamp) reading.interval = stamp - found->second.stamp;
    if (const Companion* extra = companionFor("odometry")) reading = completed(reading, *extra);
    found->second = now;
    deliver({stamp, label, reading}, frame);
  }
  takeExtra(ticksOf(odometry), "encoder counters", ticks_distrusted_, label, stamp, frame);
  takeExtra(speedsOf(odometry), "odometry velocities", speeds_distrusted_, label, stamp, frame);
}

void RawlogIntake::takePose(CObservation& observation, Stamp stamp, Frame frame) {
  const auto& pose = static_cast<CObservationRobotPose&>(observation);
  if (const Companion* extra = companionFor("passage")) {
    if (const auto fix = passageFix(pose, *extra)) {
      deliver({stamp, labelOr(observation.sensorLabel, "passage"), *fix}, frame);
      return;
    }
  }
  deliver({stamp, labelOr(observation.sensorLabel, "truth"), poseTruth(pose)}, frame);
}

}  // namespace pos::io
