#pragma once
/// Turns the objects of a rawlog, one after the other, into measurements. Private to io.

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "mrpt_conversion.hpp"
#include "pos/core/measurement.hpp"
#include "pos/io/rawlog_reader.hpp"
#include "rawlog_companion.hpp"

namespace mrpt::obs {
class CActionCollection;
class CActionRobotMovement2D;
class CSensoryFrame;
}  // namespace mrpt::obs

namespace pos::io {

template <typename T>
bool is(const mrpt::serialization::CSerializable& object) {
  return object.GetRuntimeClass() == CLASS_ID(T);
}

inline std::string classOf(const mrpt::serialization::CSerializable& object) {
  return object.GetRuntimeClass()->className;
}

class RawlogIntake {
 public:
  /// `opened` is MRPT's clock when the file was opened: a stamp between then and the moment of reading was
  /// made up by MRPT for a class version that stores none.
  explicit RawlogIntake(mrpt::Clock::time_point opened) : opened_(opened) {}

  /// An observation or frame; null for an empty place in the log.
  void take(mrpt::serialization::CSerializable* object);
  /// An action, which waits for the frame that ends its motion.
  void hold(mrpt::serialization::CSerializable::Ptr action);
  /// Settles what still waits for a later object.
  void finish();

  std::optional<Measurement> pop();
  std::optional<std::size_t> frame() const { return frame_; }
  /// The number of action/observation pairs so far, and the stamp of the last one, if any of its parts has
  /// one.
  std::size_t pairs() const { return pairs_; }
  std::optional<Stamp> pairStamp() const { return pair_stamp_; }

  LogFormat format() const;
  const LogTally& tally() const { return tally_; }

 private:
  using Frame = std::optional<std::size_t>;
  struct Queued {
    Measurement measurement;
    Frame frame;
  };
  struct OdometryReference {
    Pose2 pose;
    Stamp stamp;
  };

  void takeObservation(mrpt::obs::CObservation& observation, std::optional<Stamp> fallback, Frame frame);
  void takeFrame(mrpt::obs::CSensoryFrame& frame);
  void takeAction(mrpt::obs::CActionCollection& action, std::optional<Stamp> stamp, Frame frame);
  void takeMovement(const mrpt::obs::CActionRobotMovement2D& movement, Stamp stamp, Frame frame);
  void takeOdometry(mrpt::obs::CObservation& observation, Stamp stamp, Frame frame);
  void takeRanges(mrpt::obs::CObservation& observation, Stamp stamp, Frame frame);
  void takePose(mrpt::obs::CObservation& observation, Stamp stamp, Frame frame);
  bool takeCompanion(mrpt::obs::CObservation& observation);
  void releaseLoneAction();

  template <typename T>
  void takeSimple(std::optional<T> reading, const char* unusable, mrpt::obs::CObservation& observation,
                  Stamp stamp, Frame frame);
  template <typename T>
  void takeExtra(const Extra<T>& extra, const char* what, bool& distrusted, const std::string& label,
                 Stamp stamp, Frame frame);

  std::optional<Stamp> stampOf(mrpt::Clock::time_point stamp) const;
  /// The companion line that was written for this reading, or null.
  const Companion* companionFor(std::string_view kind) const;
  void deliver(Measurement measurement, Frame frame);
  void skip(const std::string& name) { ++tally_.skipped[name]; }
  void refuse(const std::string& reason) { ++tally_.refused[reason]; }

  mrpt::Clock::time_point opened_;
  std::vector<Queued> queue_;
  std::size_t head_ = 0;
  Frame frame_;
  LogTally tally_;

  mrpt::serialization::CSerializable::Ptr pending_action_;
  std::optional<Companion> companion_;
  mrpt::Clock::time_point companion_stamp_;
  std::map<std::string, OdometryReference> odometry_;
  WheelTicks action_ticks_;
  bool ticks_distrusted_ = false;
  bool speeds_distrusted_ = false;
  std::optional<Stamp> last_frame_stamp_;
  std::optional<Stamp> pair_stamp_;
  std::size_t pairs_ = 0;
  std::size_t observations_ = 0;
  std::size_t frames_ = 0;
  bool actions_seen_ = false;
};

}  // namespace pos::io
