#include <map>
#include <optional>
#include <set>
#include <utility>

#include "mcap_log_parts.hpp"
#include "pos/io/mcap_log.hpp"
#include "pos/io/mcap_writer.hpp"
#include "ros_messages.hpp"
#include "ros_sensors.hpp"
#include "ros_types.hpp"
#include "sound.hpp"

namespace pos::io {

struct McapLogWriter::Impl {
  explicit Impl(const std::filesystem::path& file_path) : path(file_path.string()), file(file_path) {}

  /// What is known of one sensor's topic.
  struct Topic {
    std::uint16_t channel = 0;
    std::string frame = ros::kBodyFrame;
    std::optional<Pose3> mount = {};  // as told last
    Pose2 pose = {};                  // odometry added up
    std::optional<Stamp> last = {};
  };

  Topic& topicOf(const Measurement& measurement);
  void writeOdometry(Topic& topic, Stamp stamp, const OdometryIncrement& reading);
  void tellMount(Topic& topic, Stamp stamp, const std::string& sensor, const Pose3& mount);

  std::string path;
  McapWriter file;
  std::map<std::pair<std::string, std::size_t>, Topic> topics;
  std::set<std::string> names;
  std::optional<std::uint16_t> transforms;
};

McapLogWriter::Impl::Topic& McapLogWriter::Impl::topicOf(const Measurement& measurement) {
  const auto [found, fresh] = topics.try_emplace({measurement.sensor, measurement.reading.index()});
  if (!fresh) return found->second;
  std::string name = "/" + measurement.sensor;
  if (std::holds_alternative<PoseTruth>(measurement.reading))
    name =
        std::string(kTruthTopics) + (names.count(std::string(kTruthTopics) + "/pose") == 0 ? "/pose" : name);
  if (!names.insert(name).second) names.insert(name += "/" + std::string(readingName(measurement.reading)));
  std::map<std::string, std::string> metadata{{kSensorKey, measurement.sensor}};
  if (std::holds_alternative<OdometryIncrement>(measurement.reading)) metadata[kContentKey] = kIncrements;
  found->second.channel = file.addChannel(name, ros::sensorType(measurement.reading), metadata);
  return found->second;
}

void McapLogWriter::Impl::writeOdometry(Topic& topic, Stamp stamp, const OdometryIncrement& reading) {
  ros::OdometryMessage message;
  if (!topic.last) {  // what the first increment begins from
    topic.last = stamp - reading.interval.value_or(Duration{0});
    message.head.stamp = *topic.last;
    file.write(topic.channel, *topic.last, ros::odometryMessage(message));
  }
  const double dt = seconds(stamp - *topic.last);
  topic.pose = topic.pose * reading.increment;
  topic.last = stamp;
  message.head.stamp = stamp;
  message.pose = topic.pose;
  if (dt > 0.0) {
    message.rates = Vector<3>(reading.increment.x, reading.increment.y, reading.increment.yaw) / dt;
    if (reading.covariance) message.covariance = *reading.covariance / (dt * dt);
  }
  file.write(topic.channel, stamp, ros::odometryMessage(message));
}

void McapLogWriter::Impl::tellMount(Topic& topic, Stamp stamp, const std::string& sensor,
                                    const Pose3& mount) {
  topic.frame = sensor + "_link";
  if (topic.mount && topic.mount->translation == mount.translation &&
      topic.mount->rotation.coeffs() == mount.rotation.coeffs()) {
    return;
  }
  topic.mount = mount;
  if (!transforms) transforms = file.addChannel(kStaticTransforms, ros::transformsType());
  file.write(*transforms, stamp, ros::transforms(stamp, mount, topic.frame, ros::kBodyFrame));
}

McapLogWriter::McapLogWriter(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {}
McapLogWriter::McapLogWriter(McapLogWriter&&) noexcept = default;
McapLogWriter& McapLogWriter::operator=(McapLogWriter&&) noexcept = default;
McapLogWriter::~McapLogWriter() = default;

void McapLogWriter::write(const Measurement& measurement) {
  requireSound(measurement, impl_->path);
  Impl::Topic& topic = impl_->topicOf(measurement);
  if (const auto* odometry = std::get_if<OdometryIncrement>(&measurement.reading))
    return impl_->writeOdometry(topic, measurement.stamp, *odometry);
  if (const auto* scan = std::get_if<Scan2D>(&measurement.reading))
    impl_->tellMount(topic, measurement.stamp, measurement.sensor, scan->T_body_sensor);
  const bool in_map = std::holds_alternative<PoseTruth>(measurement.reading) ||
                      std::holds_alternative<PassageFix>(measurement.reading);
  impl_->file.write(
      topic.channel, measurement.stamp,
      ros::sensorMessage(measurement.stamp, measurement.reading, in_map ? ros::kMapFrame : topic.frame));
}

void McapLogWriter::close() {
  impl_->file.close();
}

}  // namespace pos::io
