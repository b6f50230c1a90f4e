#include "object_guard.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <string_view>

namespace pos::io {
namespace {

/// A class as MRPT stores it, one layout per version from `first_version` on, as words:
///   12     twelve bytes            s   a text: count, bytes         o   an object
///   v8     count, then 8 bytes each        ?8  a flag byte, 8 bytes if it is not 0
///   { .. } count, then the group so often  i   a flag byte, 4 bytes per item of the last count
///   M      an odometry model (a count of random particles in it must be sensible)
///   G      a GNSS message: NMEA ones only
///   X      a matrix of doubles: rows, columns, elements
struct Layouts {
  std::string_view name;
  int first_version;
  std::array<std::string_view, 5> versions;
};

constexpr std::array<Layouts, 15> kLayouts{{
    {"CPoint3D", 0, {"12", "24"}},
    {"CPose2D", 0, {"12", "24"}},
    {"CPose3D", 1, {"o", "56", "96"}},
    {"CObservationIMU", 0, {"o v1 8 v4 s", "o v1 8 v8 s", "o v1 8 v8 s", "o v1 8 v8 s", "o 31 8 248 s"}},
    {"CObservationBeaconRanges", 0, {"12 { o 8 }", "12 { o 8 } o", "12 { o 8 } o s", "12 { o 8 } o s 8"}},
    {"CMatrixD", 0, {"X"}},
    {"CPose3DPDFGaussian", 1, {"o 168"}},
    {"CActionCollection", 0, {"{ o }"}},
    {"CSensoryFrame", 0, {"4 8 { o }", "4 { o }", "{ o }"}},
    {"CActionRobotMovement2D", 5, {"M 1 8 1 8", "M 1 8 1 8 8", "M ?24 ?8 8"}},
    {"CObservationOdometry", 0, {"o s 8", "o s 8 1 8 1 8", "o s 8 ?8 ?24"}},
    {"CObservation2DRangeScan", 6, {"9 o v5 16 s 8", "9 o v5 16 s 8 i"}},
    {"CObservationRobotPose", 1, {"o s 8 o"}},
    {"CObservationComment", 0, {"s 8"}},
    {"CObservationGPS", 10, {"16 s o { G }", "16 s o 1 { G }"}},
}};

constexpr std::size_t kLargest = std::size_t{1} << 28U;  // bytes in one object
constexpr int kDeepest = 8;                              // objects inside objects
constexpr std::uint32_t kMostParticles = 100'000;
constexpr std::uint32_t kMostParts = 100'000;  // MRPT builds them all before it reads the first
constexpr std::uint8_t kEndFlag = 0x88;

struct Unknown {};
struct Damage {
  std::string reason;
};

class Walk {
 public:
  explicit Walk(ByteSource& source) : source_(source) {}

  void object();
  std::size_t length() const { return at_; }

 private:
  const std::uint8_t* bytes(std::size_t count);
  void skip(std::uint64_t count);
  template <typename T>
  T value() {
    T result{};
    std::memcpy(&result, bytes(sizeof(T)), sizeof(T));
    at_ += sizeof(T);
    return result;
  }
  /// Null for a null object.
  const Layouts* header(bool& old_format, int& version);
  void layout(std::string_view words);
  void group(std::string_view words);
  void odometryModel();
  void matrix();
  void nmeaMessage();

  ByteSource& source_;
  std::size_t at_ = 0;
  std::uint32_t count_ = 0;
  int depth_ = 0;
};

std::string_view nextWord(std::string_view& words) {
  const auto end = std::min(words.find(' '), words.size());
  const std::string_view word = words.substr(0, end);
  words.remove_prefix(std::min(end + 1, words.size()));
  return word;
}

std::uint64_t numberIn(std::string_view word) {
  std::uint64_t value = 0;
  std::from_chars(word.data(), word.data() + word.size(), value);
  return value;
}

const std::uint8_t* Walk::bytes(std::size_t count) {
  const auto window = source_.peek(at_ + count);
  if (window.size() < at_ + count) throw Damage{"the file ends inside an object"};
  return window.data() + at_;
}

void Walk::skip(std::uint64_t count) {
  if (count > kLargest || at_ + count > kLargest) throw Damage{"an object claims an absurd size"};
  bytes(count);
  at_ += count;
}

const Layouts* Walk::header(bool& old_format, int& version) {
  const auto first = value<std::uint8_t>();
  old_format = (first & 0x80U) == 0;
  if (old_format) skip(3);
  const std::size_t length = first & 0x7FU;
  std::string_view name(reinterpret_cast<const char*>(bytes(length)), length);
  if (const auto colon = name.rfind(':'); colon != std::string_view::npos) name.remove_prefix(colon + 1);
  const bool null = name == "nullptr";
  const auto* const known = std::find_if(kLayouts.begin(), kLayouts.end(),
                                         [&](const Layouts& layouts) { return layouts.name == name; });
  if (known == kLayouts.end() && !null) throw Unknown{};
  at_ += length;
  if (old_format) {
    version = value<std::int32_t>();
  } else if (!null) {
    version = value<std::uint8_t>();
  }
  return null ? nullptr : known;
}

void Walk::object() {
  if (++depth_ > kDeepest) throw Damage{"objects are nested too deeply"};
  bool old_format = false;
  int version = 0;
  if (const Layouts* const known = header(old_format, version); known != nullptr) {
    const int index = version - known->first_version;
    if (index < 0 || index >= static_cast<int>(known->versions.size())) throw Unknown{};
    const std::string_view words = known->versions[static_cast<std::size_t>(index)];
    if (words.empty()) throw Unknown{};
    layout(words);
  }
  if (!old_format && value<std::uint8_t>() != kEndFlag)
    throw Damage{"an object does not end where it should"};
  --depth_;
}

void Walk::group(std::string_view words) {
  const auto count = value<std::uint32_t>();
  if (count > kMostParts) throw Damage{"an object claims an absurd number of parts"};
  for (std::uint32_t i = 0; i < count; ++i) layout(words);
}

void Walk::odometryModel() {
  if (value<std::int32_t>() != 0) throw Unknown{};  // a stored distribution instead
  object();
  const auto model = value<std::int32_t>();
  skip(6 * sizeof(float));
  const auto particles = value<std::uint32_t>();
  if (model != 0 && particles > kMostParticles) throw Damage{"an odometry action claims too many particles"};
  skip(6 * sizeof(float));
}

void Walk::nmeaMessage() {
  constexpr int kFirstNmea = 10;
  constexpr int kLastNmea = 19;
  const auto type = value<std::int32_t>();
  if (type < kFirstNmea || type > kLastNmea) throw Unknown{};
  skip(value<std::uint32_t>());
}

void Walk::matrix() {
  const std::uint64_t rows = value<std::uint32_t>();
  const std::uint64_t columns = value<std::uint32_t>();
  if (rows > kLargest || columns > kLargest) throw Damage{"an object claims an absurd size"};
  skip(rows * columns * sizeof(double));
}

void Walk::layout(std::string_view words) {
  while (!words.empty()) {
    if (words.starts_with('{')) {
      const auto end = words.find('}');
      group(words.substr(2, end - 3));
      words.remove_prefix(std::min(end + 2, words.size()));
      continue;
    }
    const std::string_view word = nextWord(words);
    switch (word.front()) {
      case 'o':
        object();
        break;
      case 's':
        skip(value<std::uint32_t>());
        break;
      case 'v':
        count_ = value<std::uint32_t>();
        skip(count_ * numberIn(word.substr(1)));
        break;
      case '?':
        if (value<std::uint8_t>() != 0) skip(numberIn(word.substr(1)));
        break;
      case 'i':
        if (value<std::uint8_t>() != 0) skip(std::uint64_t{4} * count_);
        break;
      case 'M':
        odometryModel();
        break;
      case 'G':
        nmeaMessage();
        break;
      case 'X':
        matrix();
        break;
      default:
        skip(numberIn(word));
    }
  }
}

}  // namespace

ObjectOutline outlineNext(ByteSource& source) {
  Walk walk(source);
  try {
    walk.object();
  } catch (const Unknown&) {
    return {};
  } catch (const Damage& damage) {
    return {.length = {}, .damage = damage.reason};
  }
  return {.length = walk.length(), .damage = {}};
}

}  // namespace pos::io
