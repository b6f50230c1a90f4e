/// Actions and the sensory frames that end their motion.
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <utility>

#include "rawlog_intake.hpp"

namespace pos::io {

using namespace mrpt::obs;
using mrpt::serialization::CSerializable;

void RawlogIntake::hold(CSerializable::Ptr action) {
  releaseLoneAction();
  actions_seen_ = true;
  pending_action_ = std::move(action);
}

void RawlogIntake::finish() {
  releaseLoneAction();
  if (companion_) refuse("companion line without its observation");
  companion_.reset();
}

void RawlogIntake::releaseLoneAction() {
  const CSerializable::Ptr held = std::exchange(pending_action_, nullptr);
  if (held == nullptr) return;
  if (frames_ > 0) {
    refuse("odometry action without a frame after it (the end of its motion is unknown)");
    return;
  }
  takeAction(static_cast<CActionCollection&>(*held), std::nullopt, std::nullopt);
}

void RawlogIntake::takeFrame(CSensoryFrame& frame) {
  ++frames_;
  std::optional<Stamp> stamp;
  std::optional<Stamp> any;
  for (const auto& observation : frame) {
    if (observation == nullptr) continue;
    const auto own = stampOf(observation->timestamp);
    if (!any) any = own;
    if (!stamp && is<CObservation2DRangeScan>(*observation)) stamp = own;
  }
  if (!stamp) stamp = any;
  const CSerializable::Ptr held = std::exchange(pending_action_, nullptr);
  Frame index;
  if (held != nullptr) {
    index = pairs_++;
    auto& actions = static_cast<CActionCollection&>(*held);
    for (const auto& action : actions) {
      if (!stamp && action.get() != nullptr) stamp = stampOf(action->timestamp);
    }
    pair_stamp_ = stamp;
    takeAction(actions, stamp, index);
  }
  for (const auto& observation : frame) {
    if (observation == nullptr) {
      skip("nullptr");
    } else {
      takeObservation(*observation, stamp, index);
    }
  }
  if (stamp) last_frame_stamp_ = stamp;
}

void RawlogIntake::takeAction(CActionCollection& actions, std::optional<Stamp> stamp, Frame frame) {
  for (const auto& action : actions) {
    if (action.get() == nullptr) {
      skip("nullptr");
    } else if (!is<CActionRobotMovement2D>(*action)) {
      skip(classOf(*action));
    } else if (const auto when = stamp ? stamp : stampOf(action->timestamp)) {
      takeMovement(static_cast<const CActionRobotMovement2D&>(*action), *when, frame);
    } else {
      refuse("no time stamp");
    }
  }
}

}  // namespace pos::io
