#pragma once
/// Values packed into bytes and back, as the machine keeps them (little endian), without padding. Private to
/// io.

#include <Eigen/Core>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pos/core/measurement.hpp"

namespace pos::io {

static_assert(std::endian::native == std::endian::little, "written for little-endian machines");

/// The bytes end early or hold what no writer writes.
class Unpackable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

class Packer {
 public:
  std::string bytes;

  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }

 private:
  void raw(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
  template <Plain T>
  void put(T value) {
    raw(&value, sizeof(T));
  }
  template <class T, int R, int C>
  void put(const Eigen::Matrix<T, R, C>& matrix) {
    static_assert(R > 0 && C > 0);
    raw(matrix.data(), sizeof(T) * R * C);
  }
  void put(const Eigen::Quaterniond& q) { put(q.coeffs()); }
  void put(Duration duration) { put(duration.count()); }
  void put(Stamp stamp) { put(stamp.time_since_epoch()); }
  void put(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    raw(text.data(), text.size());
  }
  template <Plain T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::uint32_t>(values.size()));
    raw(values.data(), sizeof(T) * values.size());
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
};

class Unpacker {
 public:
  Unpacker() = default;
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}

  bool atEnd() const { return bytes_.empty(); }

  template <class... T>
  void operator()(T&... values) {
    (take(values), ...);
  }

 private:
  void raw(void* target, std::size_t size) {
    if (bytes_.size() < size) throw Unpackable("the values end early");
    if (size > 0) std::memcpy(target, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  std::size_t count(std::size_t size) {
    std::uint32_t items = 0;
    take(items);
    if (items > bytes_.size() / size) throw Unpackable("a list is longer than the bytes that are left");
    return items;
  }
  template <Plain T>
  requires(!std::same_as<T, bool>) void take(T& value) { raw(&value, sizeof(T)); }
  void take(bool& value) {
    std::uint8_t byte = 0;
    take(byte);
    if (byte > 1) throw Unpackable("a yes or no is neither");
    value = byte == 1;
  }
  template <class T, int R, int C>
  void take(Eigen::Matrix<T, R, C>& matrix) {
    static_assert(R > 0 && C > 0);
    raw(matrix.data(), sizeof(T) * R * C);
  }
  void take(Eigen::Quaterniond& q) { take(q.coeffs()); }
  void take(Duration& duration) {
    Duration::rep count = 0;
    take(count);
    duration = Duration{count};
  }
  void take(Stamp& stamp) {
    Duration since{};
    take(since);
    stamp = Stamp{since};
  }
  void take(std::string& text) {
    text.resize(count(1));
    raw(text.data(), text.size());
  }
  template <Plain T>
  void take(std::vector<T>& values) {
    values.resize(count(sizeof(T)));
    raw(values.data(), sizeof(T) * values.size());
  }
  template <class T>
  void take(std::optional<T>& value) {
    bool there = false;
    take(there);
    if (!there) return value.reset();
    take(value.emplace());
  }

  std::string_view bytes_;
};

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
