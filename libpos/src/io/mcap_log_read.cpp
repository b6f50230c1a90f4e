#include <utility>

#include "cdr.hpp"
#include "file_kind.hpp"
#include "mcap_log_parts.hpp"
#include "mcap_reader.hpp"
#include "pos/io/mcap_log.hpp"
#include "ros_sensors.hpp"
#include "ros_types.hpp"

namespace pos::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOdometry = "nav_msgs/msg/Odometry";
constexpr std::string_view kTransforms = "tf2_msgs/msg/TFMessage";
constexpr std::string_view kPose = "geometry_msgs/msg/PoseStamped";

/// The static transforms of a file, and those told from outside.
class FrameTree {
 public:
  explicit FrameTree(Mounts mounts) : mounts_(std::move(mounts)) {}

  void add(const ros::Transform& transform) {
    up_[transform.child] = {transform.parent, transform.T_parent_child};
  }

  /// T_body_frame, or nothing where no chain of transforms leads from the frame to the vehicle's body.
  std::optional<Pose3> mount(const std::string& frame) const {
    Pose3 T;
    std::string at = frame;
    for (std::size_t steps = 0; steps <= up_.size(); ++steps) {
      if (const auto told = mounts_.find(at); told != mounts_.end()) return told->second * T;
      if (at == ros::kBodyFrame) return T;
      const auto found = up_.find(at);
      if (found == up_.end()) return std::nullopt;
      T = found->second.second * T;
      at = found->second.first;
    }
    return std::nullopt;  // in a circle
  }

 private:
  Mounts mounts_;
  std::map<std::string, std::pair<std::string, Pose3>> up_;
};

std::string labelOf(const McapChannel& channel) {
  if (const auto told = channel.metadata.find(kSensorKey); told != channel.metadata.end())
    return told->second;
  return channel.topic.starts_with('/') ? channel.topic.substr(1) : channel.topic;
}

bool holdsIncrements(const McapChannel& channel) {
  const auto told = channel.metadata.find(kContentKey);
  return told != channel.metadata.end() && told->second == kIncrements;
}

/// Turns what a sensor says in its own axes into the body's.
void placeOnBody(Reading& reading, const Pose3& T_body_frame) {
  if (auto* scan = std::get_if<Scan2D>(&reading)) scan->T_body_sensor = T_body_frame;
  if (auto* imu = std::get_if<ImuSample>(&reading)) {
    imu->angular = T_body_frame.rotation * imu->angular;
    imu->linear = T_body_frame.rotation * imu->linear;
  }
}

bool needsMount(const Reading& reading) {
  return std::holds_alternative<Scan2D>(reading) || std::holds_alternative<ImuSample>(reading);
}

}  // namespace

bool isMcap(const fs::path& path) {
  return beginsWith(path, kMcapMagic);
}

struct McapLogReader::Impl {
  Impl(const fs::path& path, Mounts mounts) : file(path), frames(std::move(mounts)) {}

  void take(const McapMessage& message);
  void takeOdometry(const McapMessage& message);
  void takeReading(const McapMessage& message);
  void deliver(Measurement measurement);
  void skip(const std::string& what) { ++tally.skipped[what]; }
  void finish();

  struct Reference {
    Stamp stamp;
    Pose2 pose;
  };

  McapReader file;
  FrameTree frames;
  std::map<std::uint16_t, Reference> odometry;
  std::optional<Measurement> found;
  LogTally tally;
  LogEnd end;
};

void McapLogReader::Impl::deliver(Measurement measurement) {
  if (const auto reason = defect(measurement)) {
    ++tally.refused[*reason];
  } else {
    found = std::move(measurement);
  }
}

void McapLogReader::Impl::takeOdometry(const McapMessage& message) {
  const ros::OdometryMessage now = ros::odometryFrom(message.bytes);
  const auto [before, first] = odometry.try_emplace(message.id, Reference{now.head.stamp, now.pose});
  if (first) {
    ++tally.references;
    return;
  }
  OdometryIncrement reading;
  reading.increment = inverse(before->second.pose) * now.pose;
  const Duration interval = now.head.stamp - before->second.stamp;
  if (interval > Duration{0}) reading.interval = interval;
  if (reading.interval && holdsIncrements(*message.channel) && !now.covariance.isZero(0.0))
    reading.covariance = now.covariance * (seconds(interval) * seconds(interval));
  before->second = {now.head.stamp, now.pose};
  deliver({now.head.stamp, labelOf(*message.channel), reading});
}

void McapLogReader::Impl::takeReading(const McapMessage& message) {
  const McapChannel& channel = *message.channel;
  ros::Decoded decoded = ros::sensorFrom(channel.type, message.bytes);
  if (!decoded.reading) return skip(channel.type + " " + decoded.lack);
  if (needsMount(*decoded.reading)) {
    const auto mount = frames.mount(decoded.head.frame);
    if (!mount) {
      ++tally.refused[channel.type + " in the frame '" + decoded.head.frame +
                      "', which nothing places on the vehicle: " + kStaticTransforms +
                      " has no way from it to " + ros::kBodyFrame + "; say it by --mount"];
      return;
    }
    placeOnBody(*decoded.reading, *mount);
  }
  deliver({decoded.head.stamp, labelOf(channel), std::move(*decoded.reading)});
}

void McapLogReader::Impl::take(const McapMessage& message) {
  const McapChannel& channel = *message.channel;
  try {
    if (channel.encoding != "cdr") {
      skip((channel.type.empty() ? channel.topic : channel.type) + " encoded as " + channel.encoding);
    } else if (channel.type == kOdometry) {
      takeOdometry(message);
    } else if (channel.type == kTransforms && channel.topic == kStaticTransforms) {
      for (const ros::Transform& transform : ros::transformsFrom(message.bytes)) frames.add(transform);
    } else if (!ros::isSensorType(channel.type)) {
      skip(channel.type);
    } else if (channel.type == kPose && !channel.topic.starts_with(kTruthTopics)) {
      skip(channel.type + " of other topics than " + std::string(kTruthTopics) + "...");
    } else {
      takeReading(message);
    }
  } catch (const BadCdr& bad) {
    ++tally.refused[channel.type + " that is damaged: " + bad.what()];
  }
}

void McapLogReader::Impl::finish() {
  end.objects = file.messages();
  end.byte = file.position();
  end.damaged = !file.damage().empty();
  end.message = file.damage();
}

McapLogReader::McapLogReader(const fs::path& path, Mounts mounts)
    : impl_(std::make_unique<Impl>(path, std::move(mounts))) {}

McapLogReader::McapLogReader(McapLogReader&&) noexcept = default;
McapLogReader& McapLogReader::operator=(McapLogReader&&) noexcept = default;
McapLogReader::~McapLogReader() = default;

std::optional<Measurement> McapLogReader::next() {
  while (const auto message = impl_->file.next()) {
    impl_->take(*message);
    if (impl_->found) return std::exchange(impl_->found, std::nullopt);
  }
  impl_->finish();
  return std::nullopt;
}

const LogEnd& McapLogReader::end() const {
  return impl_->end;
}

const LogTally& McapLogReader::tally() const {
  return impl_->tally;
}

}  // namespace pos::io
