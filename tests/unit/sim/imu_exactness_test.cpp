#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>
#include <cmath>

#include "pos/map/geodesy.hpp"
#include "pos/sim/imu.hpp"
#include "unit/sim/motion_checks.hpp"
#include "unit/sim/paper_motions.hpp"
#include "unit/sim/strapdown.hpp"

namespace pos::sim {
namespace {

/// Zero-noise samples of the stream, as a log would hold them.
std::vector<oracle::Sample> samplesOf(const std::shared_ptr<const Motion>& motion, const EarthConfig& earth,
                                      double rate, const Eigen::Vector3d& p_body, double duration) {
  const ImuModel model{.kind = ImuSample::Kind::Increments, .timing = {.rate = rate}, .p_body = p_body};
  const auto stream = makeImuStream(model, std::make_shared<Earth>(earth), motion, {});
  std::vector<oracle::Sample> samples;
  while (const auto delivery = stream->next()) {
    const auto& reading = std::get<ImuSample>(delivery->measurement.reading);
    const double to = static_cast<double>(samples.size() + 1) / rate;
    if (to > duration + 1e-9) break;
    EXPECT_EQ(delivery->measurement.stamp, stampFromSeconds(to));
    samples.push_back({static_cast<double>(samples.size()) / rate, to, reading.angular, reading.linear});
  }
  return samples;
}

oracle::State stateAt(const Motion& motion, const Eigen::Vector3d& p_body, double t) {
  const Kinematics body = motion.at(t);
  return {body.p_map + body.R_map_body * p_body, body.v_map + body.R_map_body * body.omega_body.cross(p_body),
          Eigen::Quaterniond(body.R_map_body)};
}

/// The same without the stream, samples also split where the truth's derivatives jump: an integrator that
/// sees such a jump inside a sample of 20 ms turns g by a wrong angle for a moment, which hundreds of seconds
/// magnify.
std::vector<oracle::Sample> splitSamples(const Motion& motion, const Earth& earth, double rate,
                                         double duration) {
  std::vector<double> ends = motion.breaks();
  for (int i = 1; i <= static_cast<int>(std::lround(duration * rate)); ++i) ends.push_back(i / rate);
  std::sort(ends.begin(), ends.end());
  std::vector<oracle::Sample> samples;
  double from = 0.0;
  for (const double to : ends) {
    if (to > duration || to - from < 1e-6) continue;
    const InertialIncrement increment = inertialIncrement(motion, earth, {0, 0, 0}, from, to);
    samples.push_back({from, to, increment.angle, increment.velocity});
    from = to;
  }
  return samples;
}

/// The largest distance between integrated samples and truth over the run.
double worstError(const std::vector<oracle::Sample>& samples, const Motion& motion,
                  const oracle::World& world, const Eigen::Vector3d& p_body) {
  const auto states = oracle::integrated(samples, stateAt(motion, p_body, 0.0), world, motion.breaks());
  double worst = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    worst = std::max(worst, (states[i].p - stateAt(motion, p_body, samples[i].to).p).norm());
  }
  return worst;
}

oracle::World flatWorld() {
  return {.gravity = [](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 0, -9.80665); }};
}

/// Gravity and rotation at a latitude from the formula of Somigliana, not from the simulator.
double somigliana(double latitude) {
  const double s2 = std::sin(latitude) * std::sin(latitude);
  return 9.7803253359 * (1.0 + 0.00193185265241 * s2) / std::sqrt(1.0 - 0.00669437999014 * s2);
}

Eigen::Vector3d earthRate(double latitude) {
  return 7.292115e-5 * Eigen::Vector3d(0.0, std::cos(latitude), std::sin(latitude));
}

}  // namespace

TEST(ImuExactness, IntegratingTheInclineRunGivesItsTruth) {
  const std::shared_ptr<const Motion> motion = makeMotion(papers::incline());
  const auto samples = samplesOf(motion, {}, 200.0, {0, 0, 0}, 75.0);
  ASSERT_EQ(samples.size(), 15000U);
  const double worst = worstError(samples, *motion, flatWorld(), {0, 0, 0});
  EXPECT_LT(worst, 1e-6);
}

TEST(ImuExactness, LeverArmChangesTheForceAndTheRunIsStillExact) {
  // Without a jump of the yaw rate, which a lever arm would turn into a blow.
  SegmentMotionConfig config = papers::loop();
  config.segments[2].turn.blend = Blend::Trapezoid;
  config.segments[2].turn.ramp = 2.0;
  const std::shared_ptr<const Motion> motion = makeMotion(config);
  const Eigen::Vector3d p_body(0.7, -0.4, 0.3);
  const auto samples = samplesOf(motion, {}, 100.0, p_body, 75.0);
  EXPECT_LT(worstError(samples, *motion, flatWorld(), p_body), 1e-6);
  EXPECT_GT(worstError(samples, *motion, flatWorld(), {0, 0, 0}), 0.1);
}

TEST(ImuExactness, OneShearerPassOnTheTurningEarthIsExact) {
  const std::shared_ptr<const Motion> motion = makeMotion(papers::shearerRun());
  const double latitude = radians(35.0);
  const EarthConfig earth{.kind = EarthKind::Level, .origin = {.latitude = latitude}};
  const double g = somigliana(latitude);
  const oracle::World world{.rotation = earthRate(latitude),
                            .gravity = [g](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 0, -g); }};
  const auto samples = samplesOf(motion, earth, 100.0, {0, 0, 0}, 3540.0);
  ASSERT_EQ(samples.size(), 354000U);
  EXPECT_LT(worstError(samples, *motion, world, {0, 0, 0}), 1e-4);
}

TEST(ImuExactness, ADriveOfKilometresFollowsThePlumbLine) {
  const std::shared_ptr<const Motion> motion = makeMotion(papers::shift());
  const map::GeodeticOrigin origin{
      .latitude = radians(37.0), .longitude = radians(112.0), .altitude = 900.0, .grid_rotation = 0.4};
  const EarthConfig earth{.kind = EarthKind::Ellipsoid, .origin = origin};
  // The world of the oracle: its own way from the map to geodetic coordinates and back to axes.
  const Eigen::Matrix3d R_enu_map = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto gravity = [&](const Eigen::Vector3d& p_map) -> Eigen::Vector3d {
    const map::GeodeticOrigin here = map::LocalFrame(origin).toGeodetic(p_map);
    double north = 0.0;
    double up = 0.0;
    GeographicLib::NormalGravity::WGS84().Gravity(degrees(here.latitude), here.altitude, north, up);
    const auto axes = [](const map::GeodeticOrigin& at) {  // columns east, north, up in ECEF
      const double sl = std::sin(at.latitude);
      const double cl = std::cos(at.latitude);
      const double so = std::sin(at.longitude);
      const double co = std::cos(at.longitude);
      Eigen::Matrix3d R;
      R << -so, -sl * co, cl * co, co, -sl * so, cl * so, 0.0, cl, sl;
      return R;
    };
    return R_enu_map.transpose() * axes(origin).transpose() * axes(here) * Eigen::Vector3d(0.0, north, up);
  };
  const oracle::World world{.rotation = R_enu_map.transpose() * earthRate(origin.latitude),
                            .gravity = gravity};
  const auto samples = splitSamples(*motion, Earth(earth), 50.0, 600.0);
  EXPECT_LT(worstError(samples, *motion, world, {0, 0, 0}), 1e-4);
  // The plumb line does turn: with gravity straight down the run would end metres away.
  const double g = gravity({0, 0, 0}).norm();
  const oracle::World straight{.rotation = world.rotation,
                               .gravity = [g](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 0, -g); }};
  EXPECT_GT(worstError(samples, *motion, straight, {0, 0, 0}), 1.0);
}

TEST(ImuExactness, AtRestItFeelsGravityUpwardsAndTheEarthTurning) {
  const std::shared_ptr<const Motion> motion =
      makeMotion(SegmentMotionConfig{.segments = {papers::wait(10)}});
  const double latitude = radians(50.0);
  const Earth earth({.kind = EarthKind::Level, .origin = {.latitude = latitude}});
  const InertialIncrement increment = inertialIncrement(*motion, earth, {1, 2, 3}, 2.0, 3.0);
  EXPECT_LT((increment.velocity - Eigen::Vector3d(0, 0, somigliana(latitude))).norm(), 1e-7);
  EXPECT_LT((increment.angle - earthRate(latitude)).norm(), 1e-12);
  const InertialIncrement flat = inertialIncrement(*motion, Earth({}), {1, 2, 3}, 2.0, 3.0);
  EXPECT_LT((flat.velocity - Eigen::Vector3d(0, 0, 9.80665)).norm(), 1e-14);
  EXPECT_EQ(flat.angle.norm(), 0.0);
}

TEST(ImuExactness, ASteadyCircleFeelsItsCentripetalForce) {
  const std::shared_ptr<const Motion> motion = makeMotion(papers::circle());
  const InertialIncrement increment = inertialIncrement(*motion, Earth({}), {0, 0, 0}, 20.0, 20.01);
  EXPECT_LT((increment.velocity / 0.01 - Eigen::Vector3d(0, 0.2, 9.80665)).norm(), 1e-11);
  EXPECT_LT((increment.angle / 0.01 - Eigen::Vector3d(0, 0, 0.1)).norm(), 1e-12);
}

TEST(ImuExactness, AJumpOfTheYawRateBelongsToTheIncrementThatEndsThere) {
  const std::shared_ptr<const Motion> motion = makeMotion(papers::circle());
  const Eigen::Vector3d p_body(0.5, 0, 0);  // gains 0.1 rad/s * 0.5 m sideways at 10 s
  const InertialIncrement before = inertialIncrement(*motion, Earth({}), p_body, 9.99, 10.0);
  const InertialIncrement after = inertialIncrement(*motion, Earth({}), p_body, 10.0, 10.01);
  EXPECT_NEAR(before.velocity.y(), 0.05, 1e-8);
  EXPECT_NEAR(after.velocity.y(), 0.2 * 0.01, 1e-9);
}

TEST(ImuExactness, IncrementsOfPartsAddUpToThoseOfTheWhole) {
  const std::shared_ptr<const Motion> motion = makeMotion(papers::laneShift());
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3000; ++i)
    angle += inertialIncrement(*motion, Earth({}), {0, 0, 0}, 0.01 * i, 0.01 * (i + 1)).angle;
  EXPECT_LT(angle.norm(), 1e-12);  // the lane shift ends with the heading it began with
  const InertialIncrement whole = inertialIncrement(*motion, Earth({}), {0, 0, 0}, 8.0, 10.0);
  EXPECT_NEAR(whole.angle.z(), -0.4, 1e-13);
}

}  // namespace pos::sim
