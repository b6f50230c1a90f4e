#pragma once
/// Logs made directly of MRPT objects.

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBeaconRanges.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <memory>
#include <vector>

#include "../../../libpos/src/io/mrpt_values.hpp"
#include "rawlog_samples.hpp"

namespace pos::io {

using namespace mrpt::obs;
using mrpt::serialization::CSerializable;

inline ReadLog readBack(const std::vector<CSerializable::Ptr>& objects) {
  const ScratchFolder folder;
  const std::string path = folder.file("log.rawlog");
  {
    mrpt::io::CFileGZOutputStream file(path);
    auto archive = mrpt::serialization::archiveFrom(file);
    for (const auto& object : objects) archive << *object;
  }
  return readWhole(path);
}

template <typename T>
std::shared_ptr<T> observed(double when, const std::string& label = "") {
  auto observation = std::make_shared<T>();
  observation->timestamp = stampToMrpt(at(when));
  observation->sensorLabel = label;
  return observation;
}

inline std::shared_ptr<CObservationOdometry> odometryAt(double when, double x, double y, double yaw) {
  auto odometry = observed<CObservationOdometry>(when, "wheels");
  odometry->odometry = {x, y, yaw};
  return odometry;
}

inline std::shared_ptr<CObservationBeaconRanges> rangesAt(mrpt::Clock::time_point stamp,
                                                          std::vector<float> ranges) {
  auto observation = std::make_shared<CObservationBeaconRanges>();
  observation->timestamp = stamp;
  std::int32_t id = 1;
  for (const float range : ranges) {
    CObservationBeaconRanges::TMeasurement measured;
    measured.beaconID = id++;
    measured.sensedDistance = range;
    observation->sensedData.push_back(measured);
  }
  return observation;
}

inline std::shared_ptr<CActionCollection> moved(double x, bool garbage = false) {
  CActionRobotMovement2D movement;
  movement.computeFromOdometry({x, 0.0, 0.0}, {});
  movement.timestamp = stampToMrpt(at(-50.0));
  if (garbage) {
    movement.hasEncodersInfo = true;
    movement.encoderLeftTicks = 2'117'699'626;
    movement.hasVelocities = true;
    movement.velocityLocal = {1.7e-39, 0.0, 0.0};
  }
  auto actions = std::make_shared<CActionCollection>();
  actions->insert(movement);
  return actions;
}

inline std::shared_ptr<CSensoryFrame> frameOf(const std::vector<CObservation::Ptr>& observations) {
  auto frame = std::make_shared<CSensoryFrame>();
  for (const auto& observation : observations) frame->insert(observation);
  return frame;
}

inline std::shared_ptr<CObservation2DRangeScan> scanAt(double when) {
  auto scan = observed<CObservation2DRangeScan>(when);
  scan->resizeScan(3);
  for (std::size_t i = 0; i < 3; ++i) {
    scan->setScanRange(i, 5.0F);
    scan->setScanRangeValidity(i, true);
  }
  return scan;
}

}  // namespace pos::io
