#pragma once
/// How packed copies of logs are laid out (docs/formats/log_cache.md). Private to io.

#include <concepts>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "packed.hpp"
#include "pos/core/measurement.hpp"
#include "pos/io/log_cache.hpp"

namespace pos::io {

inline constexpr std::string_view kCacheMagic("POSLOG\x01\n", 8);  // with the version

/// Blocks: type, length, CRC-32 of the content, content.
enum class BlockType : std::uint8_t { Head = 1, Records, End };
inline constexpr std::size_t kBlockHead = 9;

/// A record begins with the reading's index; this one gives the next label its number instead.
inline constexpr std::uint8_t kNewLabel = 255;

/// `log` as it is now; the checksum is the caller's to make.
CacheSource sourceAt(const std::filesystem::path& log, const std::string& sha256);

/// R is T or const T.
template <class R, class T>
concept As = std::same_as<std::remove_const_t<R>, T>;

/// Every field of a reading, for a Packer and an Unpacker alike.
template <class A, As<OdometryIncrement> R>
void fields(A& archive, R& r) {
  archive(r.increment.x, r.increment.y, r.increment.yaw, r.interval, r.covariance);
}
template <class A, As<WheelSpeeds> R>
void fields(A& archive, R& r) {
  archive(r.left, r.right, r.yaw_rate);
}
template <class A, As<WheelTicks> R>
void fields(A& archive, R& r) {
  archive(r.left, r.right);
}
template <class A, As<ImuSample> R>
void fields(A& archive, R& r) {
  archive(r.kind, r.angular, r.linear, r.interval);
}
template <class A, As<BeaconRange> R>
void fields(A& archive, R& r) {
  archive(r.tag, r.anchor, r.range, r.sigma, r.tag_body, r.rx_power_dbm, r.first_path_power_dbm);
}
template <class A, As<GnssFix> R>
void fields(A& archive, R& r) {
  archive(r.latitude, r.longitude, r.altitude, r.covariance_enu, r.quality);
}
template <class A, As<Scan2D> R>
void fields(A& archive, R& r) {
  archive(r.T_body_sensor.translation, r.T_body_sensor.rotation, r.angle_first, r.angle_step, r.range_max,
          r.ranges, r.valid);
}
template <class A, As<PoseTruth> R>
void fields(A& archive, R& r) {
  archive(r.T_map_body.translation, r.T_map_body.rotation);
}
template <class A, As<PassageFix> R>
void fields(A& archive, R& r) {
  archive(r.place, r.p_map, r.covariance, r.p_body, r.yaw, r.yaw_sigma);
}

}  // namespace pos::io
