#include "pos/sim/uwb_stream.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <map>

#include "pos/core/error.hpp"
#include "sensor_scene.hpp"

namespace pos::sim {
namespace {

using scene::drained;
using scene::driving;
using scene::meanBand;
using scene::meanOf;
using scene::readings;
using scene::sigmaBand;
using scene::sigmaOf;
using scene::standing;

const std::vector<map::Anchor> kFour{{.id = 1, .p_map = {0, 4, 2}},
                                     {.id = 2, .p_map = {29, 4, 2}},
                                     {.id = 3, .p_map = {29, -4, 2}},
                                     {.id = 4, .p_map = {0, -4, 2}}};

UwbConfig plain() {
  UwbConfig config;
  config.tags = {{.id = 7, .tag_body = {0.0, 0.375, 0.0}}, {.id = 8, .tag_body = {0.0, -0.375, 0.0}}};
  config.sigma = 0.0;
  return config;
}

double trueRange(const BeaconRange& reading, const Eigen::Vector3d& body) {
  const Eigen::Vector3d tag = body + reading.tag_body.value();
  return (tag - kFour[static_cast<std::size_t>(reading.anchor - 1)].p_map).norm();
}

std::vector<Delivery> run(const UwbConfig& config, std::shared_ptr<const Motion> motion,
                          const RunSetup& setup = {.seed = 1}, const LineOfSight& view = {}) {
  UwbStream stream(config, kFour, std::move(motion), setup, view);
  return drained(stream);
}

/// Range minus truth for a vehicle standing at (5, 1, 0).
std::vector<double> errorsStanding(const UwbConfig& config, double duration, std::uint64_t seed = 1) {
  const Eigen::Vector3d place(5, 1, 0);
  std::vector<double> errors;
  for (const BeaconRange& r : readings<BeaconRange>(run(config, standing(place, duration), {.seed = seed}))) {
    errors.push_back(r.range - trueRange(r, place));
  }
  return errors;
}

}  // namespace

TEST(UwbStream, WithoutErrorsEveryRangeIsTheDistanceAtItsStamp) {
  const Eigen::Vector3d velocity(1.0, 0.2, 0.0);
  for (const auto kind : {RangeSchedule::Kind::Simultaneous, RangeSchedule::Kind::Sequential}) {
    UwbConfig config = plain();
    config.schedule.kind = kind;
    config.tags[1].delay = 0.05;
    const std::vector<Delivery> all = run(config, driving({1, 0, 0}, velocity, 10.0));
    EXPECT_EQ(all.size(), 101U * 8U);
    for (const Delivery& delivery : all) {
      const auto& r = std::get<BeaconRange>(delivery.measurement.reading);
      const Eigen::Vector3d body =
          Eigen::Vector3d(1, 0, 0) + velocity * std::min(scene::secondsOf(delivery), 10.0);
      EXPECT_NEAR(r.range, trueRange(r, body), 1e-12);
    }
  }
}

TEST(UwbStream, SequentialLinksFollowEachOtherBySlots) {
  UwbConfig config = plain();
  config.schedule.kind = RangeSchedule::Kind::Sequential;
  const std::vector<Delivery> all = run(config, standing({5, 1, 0}, 0.05));
  ASSERT_EQ(all.size(), 8U);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& r = std::get<BeaconRange>(all[i].measurement.reading);
    EXPECT_EQ(all[i].measurement.stamp, stampFromSeconds(0.003 * static_cast<double>(i)));
    EXPECT_EQ(r.tag, i < 4 ? 7 : 8);
    EXPECT_EQ(r.anchor, static_cast<int>(i % 4) + 1);
  }
}

TEST(UwbStream, GaussianNoiseHasItsSigmaAndNoMean) {
  UwbConfig config = plain();
  config.sigma = 0.1;
  const std::vector<double> errors = errorsStanding(config, 500.0);
  EXPECT_NEAR(meanOf(errors), 0.0, meanBand(0.1, errors.size()));
  EXPECT_NEAR(sigmaOf(errors), 0.1, sigmaBand(0.1, errors.size()));
}

TEST(UwbStream, TwoWayRangesCarryReceiveJitterAndCountsOnly) {
  UwbConfig config = plain();
  config.mode = RangeMode::TwoWay;
  config.two_way.receive_jitter = 0.2e-9;
  const std::vector<double> errors = errorsStanding(config, 500.0);
  const double tick = kSpeedOfLight * config.two_way.tick;
  const double jitter = kSpeedOfLight * 0.2e-9 * std::sqrt(0.375);
  // Rounding down six stamps adds sum w^2 / 12 counts^2, w = 1/4, 1/4, 1/2, 1/2, 1/4, 1/4; its mean cancels.
  // For a stamp that sets a reply (T3 - T2 and T5 - T4 are fixed) rounding repeats: between 0.5 and 1.5 of
  // it.
  const double rounding = tick * std::sqrt(0.75 / 12.0);
  const double low = std::hypot(jitter, 0.5 * rounding);
  const double high = std::hypot(jitter, 1.5 * rounding);
  EXPECT_NEAR(meanOf(errors), 0.0, meanBand(high, errors.size()) + 0.001);  // 20 ppm of 25 m: 0.5 mm
  EXPECT_GT(sigmaOf(errors), low - sigmaBand(low, errors.size()));
  EXPECT_LT(sigmaOf(errors), high + sigmaBand(high, errors.size()));
}

TEST(UwbStream, TwoWayRangeOfAMovingVehicleIsThatOfTheMiddleOfTheExchange) {
  UwbConfig config = plain();
  config.mode = RangeMode::TwoWay;
  config.two_way.reply_initiator = 0.01;
  config.two_way.reply_responder = 0.01;
  const Eigen::Vector3d velocity(7.0, 0.0, 0.0);  // 14 cm an exchange
  std::vector<double> errors;
  for (const Delivery& delivery : run(config, driving({-100, 0, 0}, velocity, 10.0))) {
    const auto& r = std::get<BeaconRange>(delivery.measurement.reading);
    const double t = scene::secondsOf(delivery);
    if (t < 0.02 || t > 9.98) continue;  // the stub stands at its ends
    errors.push_back(r.range - trueRange(r, Eigen::Vector3d(-100, 0, 0) + velocity * t));
  }
  ASSERT_GT(errors.size(), 300U);
  EXPECT_NEAR(meanOf(errors), 0.0, 0.003);  // 20 ppm of 100 m and a share of a count
  for (const double error : errors) EXPECT_NEAR(error, 0.0, 0.002 + kSpeedOfLight * config.two_way.tick);
}

TEST(UwbStream, AntennaDelayLeftOverByCalibrationShiftsALinkForGood) {
  UwbConfig config = plain();
  config.mode = RangeMode::TwoWay;
  config.devices.rate_error_max = 0.0;
  config.devices.antenna_delay_sigma = 1e-9;
  std::vector<double> shifts;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const std::vector<double> errors = errorsStanding(config, 1.0, seed);
    EXPECT_LT(sigmaOf({errors[0], errors[8], errors[16]}), kSpeedOfLight * config.two_way.tick);
    shifts.push_back(errors[0]);
  }
  // Two radios, each with its delay on both of its ways, and counts.
  const double expected = std::hypot(kSpeedOfLight * 1e-9 * std::sqrt(2.0), 0.25 * kSpeedOfLight * 15.65e-12);
  EXPECT_NEAR(sigmaOf(shifts), expected, sigmaBand(expected, shifts.size()));
}

TEST(UwbStream, TagNoiseGivesRangesThatMeetInTheNoisyTag) {
  UwbConfig config = plain();
  config.mode = RangeMode::TagNoise;
  config.sigma = 0.05;
  const std::vector<BeaconRange> ranges = readings<BeaconRange>(run(config, standing({5, 1, 2}, 400.0)));
  std::vector<double> x;
  std::vector<double> y;
  for (std::size_t i = 0; i + 3 < ranges.size(); i += 4) {
    // Differences of squares against the first anchor, all at the tag's height.
    Eigen::Matrix<double, 3, 2> A;
    Eigen::Vector3d b;
    for (int j = 1; j < 4; ++j) {
      const Eigen::Vector2d a0 = kFour[0].p_map.head<2>();
      const Eigen::Vector2d aj = kFour[static_cast<std::size_t>(j)].p_map.head<2>();
      const double r0 = ranges[i].range;
      const double rj = ranges[i + static_cast<std::size_t>(j)].range;
      A.row(j - 1) = 2.0 * (aj - a0).transpose();
      b[j - 1] = r0 * r0 - rj * rj + aj.squaredNorm() - a0.squaredNorm();
    }
    const Eigen::Vector2d tag = A.colPivHouseholderQr().solve(b);
    EXPECT_LT((A * tag - b).norm(), 1e-9);
    x.push_back(tag.x() - 5.0);
    y.push_back(tag.y() - 1.0 - ranges[i].tag_body->y());
  }
  ASSERT_EQ(x.size(), 4001U * 2U);
  for (const std::vector<double>& axis : {x, y}) {
    EXPECT_NEAR(meanOf(axis), 0.0, meanBand(0.05, axis.size()));
    EXPECT_NEAR(sigmaOf(axis), 0.05, sigmaBand(0.05, axis.size()));
  }
}

TEST(UwbStream, TagPositionsAreFixesOfEachTag) {
  UwbConfig config = plain();
  config.mode = RangeMode::TagPosition;
  config.sigma = 0.05;
  config.sigma_z = 0.02;
  const std::vector<Delivery> all = run(config, standing({5, 1, 0}, 200.0));
  std::vector<double> x;
  std::vector<double> z;
  for (const Delivery& delivery : all) {
    ASSERT_FALSE(defect(delivery.measurement));
    const auto& fix = std::get<PassageFix>(delivery.measurement.reading);
    EXPECT_TRUE(fix.place == "tag 7" || fix.place == "tag 8");
    EXPECT_NEAR(fix.p_map.y(), fix.place == "tag 7" ? 1.375 : 0.625, 0.375);
    EXPECT_DOUBLE_EQ(fix.covariance(0, 0), 0.0025);
    EXPECT_DOUBLE_EQ(fix.covariance(2, 2), 0.0004);
    x.push_back(fix.p_map.x());
    z.push_back(fix.p_map.z());
  }
  EXPECT_EQ(x.size(), 2001U * 2U);
  EXPECT_NEAR(sigmaOf(x), 0.05, sigmaBand(0.05, x.size()));
  EXPECT_NEAR(sigmaOf(z), 0.02, sigmaBand(0.02, z.size()));
}

TEST(UwbStream, ZonesSetTheNoiseAndCanSilenceTheRadio) {
  UwbConfig config = plain();
  config.sigma = 0.3;
  config.zones = {{.where = {.time = TimeSpan{0.0, 100.0}}, .silent = true},
                  {.where = {.time = TimeSpan{100.0, 400.0}}, .sigma = {0.5, 0.5}},
                  {.where = {.time = TimeSpan{400.0, 700.0}}, .sigma = {0.12, 0.12}}};
  std::map<int, std::vector<double>> errors;
  for (const Delivery& delivery : run(config, standing({5, 1, 0}, 1000.0))) {
    const auto& r = std::get<BeaconRange>(delivery.measurement.reading);
    const double t = scene::secondsOf(delivery);
    errors[t < 100.0 ? 0 : static_cast<int>((t - 100.0) / 300.0) + 1].push_back(r.range -
                                                                                trueRange(r, {5, 1, 0}));
  }
  EXPECT_EQ(errors.count(0), 0U);
  EXPECT_NEAR(sigmaOf(errors[1]), 0.5, sigmaBand(0.5, errors[1].size()));
  EXPECT_NEAR(sigmaOf(errors[2]), 0.12, sigmaBand(0.12, errors[2].size()));
  EXPECT_NEAR(sigmaOf(errors[3]), 0.3, sigmaBand(0.3, errors[3].size()));
}

TEST(UwbStream, ReportsPowersByDistanceAndHiding) {
  UwbConfig config = plain();
  config.power = RadioPower{};
  config.errors.episodes = {{.anchor = 2, .when = {0.0, 1e3}}};
  std::map<AnchorId, std::vector<double>> total;
  std::map<AnchorId, std::vector<double>> gap;
  for (const BeaconRange& r : readings<BeaconRange>(run(config, standing({5, 1, 0}, 200.0)))) {
    if (r.tag != 7) continue;
    total[r.anchor].push_back(r.rx_power_dbm.value());
    gap[r.anchor].push_back(r.rx_power_dbm.value() - r.first_path_power_dbm.value());
  }
  for (const map::Anchor& anchor : kFour) {
    const double d = (Eigen::Vector3d(5, 1.375, 0) - anchor.p_map).norm();
    const double hidden = anchor.id == 2 ? 1.0 : 0.0;
    const std::size_t n = total[anchor.id].size();
    EXPECT_NEAR(meanOf(total[anchor.id]), -63.0 - 20.0 * std::log10(d) - 6.0 * hidden, meanBand(1.0, n));
    EXPECT_NEAR(meanOf(gap[anchor.id]), 2.0 + 10.0 * hidden, meanBand(std::sqrt(2.0), n));
  }
}

TEST(UwbStream, SameSeedSameBytesWhoeverElseRuns) {
  UwbConfig config = plain();
  config.mode = RangeMode::TwoWay;
  config.two_way.receive_jitter = 0.2e-9;
  config.errors.blocks = NlosBlocks{};
  config.errors.process = NlosProcess{};
  config.errors.outliers.probability = 0.05;
  config.power = RadioPower{};
  const auto motion = driving({1, 0, 0}, {1, 0, 0}, 20.0);
  const std::string first = scene::spelled(run(config, motion));
  EXPECT_EQ(first, scene::spelled(run(config, motion)));
  EXPECT_NE(first, scene::spelled(run(config, motion, {.seed = 2})));

  UwbConfig other = config;
  other.timing.stream = wideStreamOf("other");
  UwbStream a(config, kFour, motion, {.seed = 1});
  UwbStream b(other, kFour, motion, {.seed = 1});
  std::vector<Delivery> from_a;
  while (std::optional<Delivery> delivery = a.next()) {
    from_a.push_back(*delivery);
    (void)b.next();
  }
  EXPECT_EQ(first, scene::spelled(from_a));
  EXPECT_NE(first, scene::spelled(run(other, motion)));
}

TEST(UwbStream, RefusesASetUpThatCannotWork) {
  const auto motion = standing({0, 0, 0}, 1.0);
  UwbConfig config = plain();
  config.tags[1].id = 7;
  EXPECT_THROW((void)validated(config), ConfigError);
  config = plain();
  config.schedule = {.kind = RangeSchedule::Kind::Sequential, .slot = 0.02};
  EXPECT_THROW(UwbStream(config, kFour, motion, {}), ConfigError);
  EXPECT_THROW(UwbStream(plain(), {}, motion, {}), ConfigError);
  config = plain();
  config.errors.outliers.probability = -0.1;
  EXPECT_THROW((void)validated(config), ConfigError);
  config = plain();
  config.tags.clear();
  EXPECT_THROW((void)validated(config), ConfigError);
}

}  // namespace pos::sim
