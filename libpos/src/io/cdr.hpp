#pragma once
/// Values as ROS 2 stores them: plain CDR (OMG DDS-RTPS), little endian, each number at a multiple of its
/// size counted from behind the four bytes of the head. Private to io.

#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace pos::io {

static_assert(std::endian::native == std::endian::little, "written for little-endian machines");

class CdrWriter {
 public:
  CdrWriter() : bytes_(kHead, kHead + 4) {}

  template <class T>
  requires std::is_arithmetic_v<T> CdrWriter& operator<<(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back('\0');
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
    return *this;
  }
  CdrWriter& operator<<(const std::string& text) {
    *this << static_cast<std::uint32_t>(text.size() + 1);
    bytes_.append(text.c_str(), text.size() + 1);
    return *this;
  }
  /// The length of a sequence, before its items.
  CdrWriter& count(std::size_t items) { return *this << static_cast<std::uint32_t>(items); }

  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr char kHead[] = {0, 1, 0, 0};
  std::string bytes_;
};

/// The bytes are no such message.
class BadCdr : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class CdrReader {
 public:
  /// Throws BadCdr unless the bytes are plain CDR, little endian.
  explicit CdrReader(std::string_view bytes) : bytes_(bytes) {
    if (bytes.size() < kHead) throw BadCdr("shorter than its head");
    if (bytes[0] != 0 || bytes[1] != 1) throw BadCdr("not in plain little-endian CDR");
  }

  template <class T>
  requires std::is_arithmetic_v<T> CdrReader& operator>>(T& value) {
    at_ = kHead + (at_ - kHead + sizeof(T) - 1) / sizeof(T) * sizeof(T);
    std::memcpy(&value, take(sizeof(T)), sizeof(T));
    return *this;
  }
  CdrReader& operator>>(std::string& text) {
    const std::uint32_t size = count(1);
    const char* const begin = take(size);
    text.assign(begin, size > 0 ? size - 1 : 0);
    return *this;
  }
  /// The length of a sequence whose items take at least `size` bytes each.
  std::uint32_t count(std::size_t size) {
    std::uint32_t items = 0;
    *this >> items;
    if (items > (bytes_.size() - at_) / size) throw BadCdr("a list is longer than the message");
    return items;
  }

 private:
  static constexpr std::size_t kHead = 4;
  const char* take(std::size_t size) {
    if (at_ > bytes_.size() || size > bytes_.size() - at_) throw BadCdr("the message ends early");
    const char* const begin = bytes_.data() + at_;
    at_ += size;
    return begin;
  }

  std::string_view bytes_;
  std::size_t at_ = kHead;
};

}  // namespace pos::io
