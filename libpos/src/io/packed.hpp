#pragma once
/// Values packed into bytes and back, as the machine keeps them (little endian), without padding. Private to
/// io.

#include <zlib.h>

#include <Eigen/Geometry>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "pos/core/stamp.hpp"

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
  void put(std::string_view text) {
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
  std::string_view rest() const { return bytes_; }

  template <class T>
  T value() {
    T result{};
    take(result);
    return result;
  }
  /// The next `size` bytes where they lie.
  std::string_view bytes(std::uint64_t size) {
    if (size > bytes_.size()) throw Unpackable("the values end early");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  /// A text where it lies.
  std::string_view text() { return bytes(value<std::uint32_t>()); }

  template <class... T>
  void operator()(T&... values) {
    (take(values), ...);
  }

 private:
  void raw(void* target, std::size_t size) {
    const std::string_view taken = bytes(size);
    if (size > 0) std::memcpy(target, taken.data(), size);
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

/// The values one behind the other.
template <class... T>
std::string packedBytes(const T&... values) {
  Packer packer;
  packer(values...);
  return std::move(packer.bytes);
}

/// CRC-32 of zlib and gzip, `before` being that of what stands before.
inline std::uint32_t crcOf(std::string_view bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace pos::io
