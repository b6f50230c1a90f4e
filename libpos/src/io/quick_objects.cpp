#include "quick_objects.hpp"

#include <mrpt/obs/CObservationBeaconRanges.h>
#include <mrpt/obs/CObservationIMU.h>

#include <array>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace pos::io {
namespace {

using mrpt::obs::CObservationBeaconRanges;
using mrpt::obs::CObservationIMU;
using mrpt::serialization::CSerializable;

// An object begins with the length of its class name (high bit set), the name and the version, and ends with
// a mark.
constexpr std::string_view kImu("\x9amrpt::obs::CObservationIMU\x04", 28);
constexpr std::string_view kRanges("\xa3mrpt::obs::CObservationBeaconRanges\x03", 37);
constexpr std::string_view kPose3("\x94mrpt::poses::CPose3D\x03", 22);
constexpr std::string_view kPose2("\x94mrpt::poses::CPose2D\x01", 22);
constexpr std::string_view kPoint3("\x95mrpt::poses::CPoint3D\x01", 23);
constexpr std::string_view kEnd("\x88", 1);

constexpr std::uint32_t kMostRanges = 16;
constexpr std::uint32_t kLongestLabel = 256;

/// Bytes in order; once something is missing or other than expected, all that follows is.
class Cursor {
 public:
  explicit Cursor(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  bool good() const { return good_; }
  std::size_t position() const { return at_; }

  void expect(std::string_view words) {
    const std::uint8_t* const found = take(words.size());
    good_ = good_ && std::memcmp(found, words.data(), words.size()) == 0;
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void into(T& value) {
    if (const std::uint8_t* const found = take(sizeof(T)); good_) std::memcpy(&value, found, sizeof(T));
  }
  template <class T>
  T value() {
    T result{};
    into(result);
    return result;
  }
  void into(std::string& text) {
    const auto size = value<std::uint32_t>();
    good_ = good_ && size <= kLongestLabel;
    const std::uint8_t* const found = take(good_ ? size : 0);
    if (good_) text.assign(reinterpret_cast<const char*>(found), size);
  }

 private:
  const std::uint8_t* take(std::size_t count) {
    good_ = good_ && count <= bytes_.size() - at_;
    const std::uint8_t* const found = bytes_.data() + at_;
    if (good_) at_ += count;
    return found;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

mrpt::Clock::time_point stampFrom(Cursor& in) {
  return mrpt::Clock::time_point(mrpt::Clock::duration(in.value<mrpt::Clock::rep>()));
}

void read(Cursor& in, CObservationIMU& imu) {
  std::array<double, 12> pose{};  // translation, rotation matrix row by row
  in.expect(kPose3);
  in.into(pose);
  in.expect(kEnd);
  in.into(imu.dataIsPresent);
  imu.timestamp = stampFrom(in);
  in.into(imu.rawMeasurements);
  in.into(imu.sensorLabel);
  mrpt::math::CMatrixDouble33 rotation(mrpt::math::UNINITIALIZED_MATRIX);
  std::memcpy(rotation.data(), pose.data() + 3, 9 * sizeof(double));
  imu.sensorPose.setRotationMatrix(rotation);
  imu.sensorPose.x(pose[0]);
  imu.sensorPose.y(pose[1]);
  imu.sensorPose.z(pose[2]);
}

void read(Cursor& in, CObservationBeaconRanges& ranges) {
  in.into(ranges.minSensorDistance);
  in.into(ranges.maxSensorDistance);
  in.into(ranges.stdError);
  const auto count = in.value<std::uint32_t>();
  ranges.sensedData.resize(count <= kMostRanges ? count : 0);
  for (auto& range : ranges.sensedData) {
    in.expect(kPoint3);
    const auto place = in.value<std::array<double, 3>>();
    in.expect(kEnd);
    range.sensorLocationOnRobot = mrpt::poses::CPoint3D(place[0], place[1], place[2]);
    in.into(range.sensedDistance);
    in.into(range.beaconID);
  }
  in.expect(kPose2);
  const auto pose = in.value<std::array<double, 3>>();
  in.expect(kEnd);
  ranges.auxEstimatePose = mrpt::poses::CPose2D(pose[0], pose[1], pose[2]);
  in.into(ranges.sensorLabel);
  ranges.timestamp = stampFrom(in);
}

template <class T>
std::size_t readAs(std::span<const std::uint8_t> bytes, std::string_view head, CSerializable::Ptr& object) {
  const bool own = object != nullptr && object.use_count() == 1 && object->GetRuntimeClass() == CLASS_ID(T);
  if (!own) object = T::Create();
  Cursor in(bytes);
  in.expect(head);
  read(in, static_cast<T&>(*object));
  in.expect(kEnd);
  return in.good() ? in.position() : 0;
}

bool beginsWith(std::span<const std::uint8_t> bytes, std::string_view head) {
  return bytes.size() >= head.size() && std::memcmp(bytes.data(), head.data(), head.size()) == 0;
}

}  // namespace

std::size_t readQuickly(std::span<const std::uint8_t> bytes, CSerializable::Ptr& object) {
  if (beginsWith(bytes, kImu)) return readAs<CObservationIMU>(bytes, kImu, object);
  if (beginsWith(bytes, kRanges)) return readAs<CObservationBeaconRanges>(bytes, kRanges, object);
  return 0;
}

}  // namespace pos::io
