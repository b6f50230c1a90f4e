#include "ros_types.hpp"

namespace pos::io::ros {

RosType typeOf(const char* name, const char* fields, std::initializer_list<Part> parts) {
  RosType type{name, fields};
  for (const Part& part : parts)
    type.definition += std::string(80, '=') + "\nMSG: " + part.name + "\n" + part.fields;
  return type;
}

CdrWriter& operator<<(CdrWriter& out, const Eigen::Vector3d& v) {
  return out << v.x() << v.y() << v.z();
}
CdrWriter& operator<<(CdrWriter& out, const Eigen::Quaterniond& q) {
  return out << q.x() << q.y() << q.z() << q.w();
}
CdrWriter& operator<<(CdrWriter& out, const Matrix<6, 6>& P) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) out << P(i, j);
  }
  return out;
}
CdrWriter& operator<<(CdrWriter& out, const Pose3& T) {
  return out << T.translation << T.rotation;
}

CdrWriter& header(CdrWriter& out, Stamp stamp, const std::string& frame) {
  const auto since = stamp.time_since_epoch();
  const auto whole = std::chrono::floor<std::chrono::seconds>(since);
  const auto rest = std::chrono::duration_cast<std::chrono::nanoseconds>(since - whole);
  return out << static_cast<std::int32_t>(whole.count()) << static_cast<std::uint32_t>(rest.count()) << frame;
}

}  // namespace pos::io::ros
