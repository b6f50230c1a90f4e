/// A minute of the `legs` simulation from a rawlog in the repository: what is in it, and that the legs found
/// in its sweeps are those of the right supports.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <variant>

#include "pos/core/angle.hpp"
#include "pos/io/rawlog_reader.hpp"
#include "pos/io/scenario_yaml.hpp"
#include "pos/io/trajectory_io.hpp"
#include "pos/lidar/leg_association.hpp"
#include "pos/lidar/legs.hpp"
#include "pos/sim/scenario.hpp"

namespace pos::io {
namespace {

const std::filesystem::path kRoot = POS_SOURCE_DIR;

/// The simulation's truth at `stamp`, between two poses of 5 Hz.
Pose3 bodyAt(const Truth& truth, Stamp stamp) {
  const auto after = std::find_if(truth.poses.begin() + 1, truth.poses.end() - 1,
                                  [stamp](const TruthPose& pose) { return pose.stamp >= stamp; });
  const auto before = after - 1;
  const double share = seconds(stamp - before->stamp) / seconds(after->stamp - before->stamp);
  const Pose3& a = before->T_map_body;
  const Pose3& b = after->T_map_body;
  return {a.translation + share * (b.translation - a.translation), a.rotation.slerp(share, b.rotation)};
}

/// Where the simulator put the legs: beside the bent line of the first pass, on which the whole minute lies.
std::vector<lidar::PredictedLeg> trueLegs() {
  const sim::Scenario scenario = loadScenario(kRoot / "configs/scenarios/shearer_legs.yaml", {}, {});
  const auto shearer = sim::makeShearerMotion(std::get<sim::ShearerConfig>(scenario.motion));
  std::vector<lidar::PredictedLeg> legs;
  for (int support = 0; support < 40; ++support) {
    const Eigen::Vector3d p = shearer->pointOnLine(0, -15.0 + 1.5 * support);
    legs.push_back({support, {p.x() - 4.0, p.y()}});
  }
  return legs;
}

/// What a filter knows of the row: supports every 1.5 m, 4 m beside the line.
std::vector<lidar::PredictedLeg> nominalLegs() {
  std::vector<lidar::PredictedLeg> legs;
  for (int support = 0; support < 40; ++support) legs.push_back({support, {-4.0, -15.0 + 1.5 * support}});
  return legs;
}

/// All sweeps of the supports' scanner.
struct Clip {
  std::map<std::string, int> counts = {};
  std::vector<Measurement> sweeps = {};
  bool damaged = true;
};

Clip readClip() {
  RawlogReader reader((kRoot / "rawlogs/shearer_legs_clip.rawlog").string());
  Clip clip;
  while (auto measurement = reader.next()) {
    ++clip.counts[measurement->sensor];
    if (measurement->sensor == "lidar") clip.sweeps.push_back(std::move(*measurement));
  }
  clip.damaged = reader.end().damaged;
  return clip;
}

/// Legs in map axes, with the mount as `T_body_sensor`.
std::vector<Eigen::Vector2d> onMap(const lidar::LegSweep& sweep, const Pose3& T_map_sensor) {
  std::vector<Eigen::Vector2d> points;
  for (const lidar::LegDetection& leg : sweep.legs) {
    points.emplace_back((T_map_sensor * Eigen::Vector3d(leg.centre.x(), leg.centre.y(), 0.0)).head<2>());
  }
  return points;
}

}  // namespace

TEST(LegClip, HoldsAMinuteOfAllSensors) {
  const Clip clip = readClip();
  EXPECT_FALSE(clip.damaged);
  EXPECT_EQ(clip.counts.at("imu"), 6000);
  EXPECT_EQ(clip.counts.at("odometer"), 1500);
  EXPECT_EQ(clip.counts.at("lidar"), 1501);
  EXPECT_EQ(clip.counts.at("roadway"), 7);
  EXPECT_EQ(std::get<Scan2D>(clip.sweeps.front().reading).ranges.size(), 721U);
}

TEST(LegClip, LegsFoundAreThoseOfTheRightSupports) {
  const Clip clip = readClip();
  const Truth truth = readTumTruth(kRoot / "rawlogs/shearer_legs_clip_truth.tum");
  const auto real = trueLegs();
  const auto nominal = nominalLegs();
  lidar::LegFinder finder({});
  int matched = 0;
  int dropped = 0;
  int wrong = 0;
  int in_dust = 0;
  std::set<int> supports;
  for (const Measurement& sweep : clip.sweeps) {
    const auto& scan = std::get<Scan2D>(sweep.reading);
    const double t = seconds(sweep.stamp - clip.sweeps.front().stamp);
    const lidar::LegSweep found = finder.find(scan);
    EXPECT_EQ(found.counts.beams, 721);
    if (t >= 40.0 && t < 45.0) {
      in_dust += static_cast<int>(found.legs.size());
      EXPECT_LT(found.counts.returns, 60);
    } else {
      EXPECT_GE(found.legs.size(), 12U) << t;
    }
    const auto points = onMap(found, bodyAt(truth, sweep.stamp) * scan.T_body_sensor);
    const auto answers = lidar::associated(points, nominal);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (answers[i].match != lidar::LegMatch::Matched) {
        ++dropped;
        continue;
      }
      const int support = nominal[static_cast<std::size_t>(answers[i].predicted)].support;
      const auto nearest = std::min_element(real.begin(), real.end(), [&](const auto& a, const auto& b) {
        return (a.p - points[i]).norm() < (b.p - points[i]).norm();
      });
      ++(nearest->support == support ? matched : wrong);
      supports.insert(support);
    }
  }
  EXPECT_GT(matched, 21500);  // 1376 sweeps with 16 legs in view
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(dropped, 0);
  EXPECT_LT(in_dust, 125);  // of 125 sweeps: the nearest, with 4 of 17 points
  EXPECT_GE(supports.size(), 20U);
}

// With the scanner calibrated and its true mount, what is left is the noise (4 to 6 mm) and the bias of the
// tilt (2 mm): nothing was lost on the way through the log.
TEST(LegClip, CalibratedLegsStandWhereTheSimulatorPutThem) {
  const Clip clip = readClip();
  const Truth truth = readTumTruth(kRoot / "rawlogs/shearer_legs_clip_truth.tum");
  const auto real = trueLegs();
  const Pose3 T_body_sensor{Eigen::Vector3d::Zero(),
                            quaternionFromRotationVector({0.0, radians(0.01), radians(0.425)})};
  lidar::LegFinder finder({.tilt = radians(10.0), .calibration = lidar::ScannerCalibration::paper()});
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < clip.sweeps.size(); k += 10) {
    const auto& scan = std::get<Scan2D>(clip.sweeps[k].reading);
    const auto points = onMap(finder.find(scan), bodyAt(truth, clip.sweeps[k].stamp) * T_body_sensor);
    const auto answers = lidar::associated(points, real);
    for (std::size_t i = 0; i < points.size(); ++i) {
      squares += 0.5 * answers[i].distance * answers[i].distance;
      count += 1.0;
    }
  }
  EXPECT_GT(count, 2000.0);
  EXPECT_LT(std::sqrt(squares / count), 0.007);
}

}  // namespace pos::io
