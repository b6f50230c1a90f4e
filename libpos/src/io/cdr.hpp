#pragma once
/// Values as ROS 2 stores them: plain CDR (OMG DDS-RTPS), little endian, each number at a multiple of its
/// size counted from behind the four bytes of the head. Private to io.

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
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

}  // namespace pos::io
