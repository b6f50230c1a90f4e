// One function per kind of table: the current row as a reading in SI units.
#include <Eigen/Geometry>
#include <cmath>

#include "import_table.hpp"

namespace pos::io {
namespace {

using Row = std::function<Reading()>;
using Field = ImportTable::Field;

/// Increment of a body that drove `distance` along an arc that turned it by `heading`.
Pose2 arc(double distance, double heading) {
  const double half = 0.5 * heading;
  const double chord = std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  return {distance * chord * std::cos(half), distance * chord * std::sin(half), heading};
}

Row odometryRow(const ImportTable& table) {
  return [&table, distance = table.field("distance"), heading = table.field("heading"),
          interval = table.findField("interval")]() -> Reading {
    return OdometryIncrement{
        arc(table.number(distance), table.number(heading)), table.duration(interval), {}};
  };
}

Row odometryPoseRow(const ImportTable& table) {
  return [&table, dx = table.field("dx"), dy = table.field("dy"), dyaw = table.field("dyaw"),
          interval = table.findField("interval")]() -> Reading {
    return OdometryIncrement{
        {table.number(dx), table.number(dy), table.number(dyaw)}, table.duration(interval), {}};
  };
}

Row wheelSpeedsRow(const ImportTable& table) {
  return [&table, left = table.field("left"), right = table.field("right"),
          yaw_rate = table.findField("yaw_rate")]() -> Reading {
    return WheelSpeeds{table.number(left), table.number(right), table.number(yaw_rate)};
  };
}

Row wheelTicksRow(const ImportTable& table) {
  return [&table, left = table.field("left"), right = table.field("right")]() -> Reading {
    return WheelTicks{table.integer(left), table.integer(right)};
  };
}

struct Axes {
  Field x, y, z;
  Eigen::Vector3d of(const ImportTable& table) const {
    return {table.number(x), table.number(y), table.number(z)};
  }
};

Row imuRow(const ImportTable& table, ImuSample::Kind kind, const Axes& angular, const Axes& linear) {
  return [&table, kind, angular, linear, interval = table.findField("interval")]() -> Reading {
    return ImuSample{kind, angular.of(table), linear.of(table), table.duration(interval)};
  };
}

Row imuRatesRow(const ImportTable& table) {
  return imuRow(table, ImuSample::Kind::Rates, {table.field("wx"), table.field("wy"), table.field("wz")},
                {table.field("ax"), table.field("ay"), table.field("az")});
}

Row imuIncrementsRow(const ImportTable& table) {
  return imuRow(table, ImuSample::Kind::Increments,
                {table.field("dax"), table.field("day"), table.field("daz")},
                {table.field("dvx"), table.field("dvy"), table.field("dvz")});
}

/// Where the tag sits; nothing when the mapping lists no tags.
std::optional<Eigen::Vector3d> mountOf(TagId tag, const TagPlaces& tags, const ImportTable& table,
                                       const Field& field) {
  if (tags.empty()) return {};
  for (const auto& [id, p_body] : tags) {
    if (id == tag) return p_body;
  }
  std::string known;
  for (const auto& [id, p_body] : tags) known += (known.empty() ? "" : ", ") + std::to_string(id);
  table.refuse(field, "a range of a tag whose place on the body is not given", std::to_string(tag),
               "one of " + known);
}

Row rangeRow(const ImportTable& table, const TagPlaces& tags) {
  return
      [&table, tags, tag = table.field("tag"), anchor = table.field("anchor"), range = table.field("range"),
       sigma = table.findField("sigma"), rx_power = table.findField("rx_power"),
       first_path_power = table.findField("first_path_power")]() -> Reading {
        BeaconRange reading;
        reading.tag = table.id(tag);
        reading.anchor = table.id(anchor);
        reading.range = table.number(range);
        reading.sigma = table.number(sigma);
        reading.tag_body = mountOf(reading.tag, tags, table, tag);
        reading.rx_power_dbm = table.number(rx_power);
        reading.first_path_power_dbm = table.number(first_path_power);
        return reading;
      };
}

GnssFix::Quality qualityOf(const ImportTable& table, const std::optional<Field>& fix_status) {
  if (!fix_status) return GnssFix::Quality::Autonomous;
  const std::int64_t found = table.integer(*fix_status);
  std::string known;
  for (const auto& [code, quality] : table.mapping().fix_codes) {
    if (code == found) return quality;
    known += (known.empty() ? "" : ", ") + std::to_string(code);
  }
  table.refuse(*fix_status, "the mapping's fix_codes do not explain this code", std::to_string(found),
               "one of " + known);
}

Row gnssRow(const ImportTable& table) {
  const Axes position{table.field("latitude"), table.field("longitude"), table.field("altitude")};
  const Axes sigmas{table.field("sigma_east"), table.field("sigma_north"), table.field("sigma_up")};
  return [&table, position, sigmas, fix_status = table.findField("fix_status")]() -> Reading {
    const Eigen::Vector3d p = position.of(table);
    const Matrix<3, 3> covariance = sigmas.of(table).cwiseAbs2().asDiagonal();
    return GnssFix{p.x(), p.y(), p.z(), covariance, qualityOf(table, fix_status)};
  };
}

}  // namespace

std::function<Reading()> rowReader(const ImportTable& table, const TagPlaces& tags) {
  const std::string& kind = table.mapping().kind;
  if (kind == "odometry") return odometryRow(table);
  if (kind == "odometry_pose") return odometryPoseRow(table);
  if (kind == "wheel_speeds") return wheelSpeedsRow(table);
  if (kind == "wheel_ticks") return wheelTicksRow(table);
  if (kind == "imu") return imuRatesRow(table);
  if (kind == "imu_increments") return imuIncrementsRow(table);
  if (kind == "ranges") return rangeRow(table, tags);
  ensure(kind == "gnss", "a kind of stream without a row reader");
  return gnssRow(table);
}

std::function<TruthPose()> truthReader(const ImportTable& table) {
  return [&table, x = table.field("x"), y = table.field("y"), z = table.findField("z"),
          yaw = table.findField("yaw"), qw = table.findField("qw"), qx = table.findField("qx"),
          qy = table.findField("qy"), qz = table.findField("qz")]() {
    const double height = z ? table.number(*z) : 0.0;
    const double heading = yaw ? table.number(*yaw) : 0.0;
    const Pose2 planar{table.number(x), table.number(y), wrapAngle(heading)};
    TruthPose pose{table.stamp(), Pose3::fromPlanar(planar, height)};
    if (!qw) return pose;
    const Eigen::Quaterniond q{table.number(*qw), table.number(*qx), table.number(*qy), table.number(*qz)};
    if (std::abs(q.norm() - 1.0) > 0.01) {
      table.refuse(*qw, "the quaternion does not have length 1", "length " + text::shortest(q.norm()),
                   "0.99 .. 1.01");
    }
    pose.T_map_body.rotation = q.normalized();
    return pose;
  };
}

}  // namespace pos::io
