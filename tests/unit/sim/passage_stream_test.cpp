#include "pos/sim/passage_stream.hpp"

#include <gtest/gtest.h>

#include <map>

#include "pos/core/error.hpp"
#include "sensor_scene.hpp"

namespace pos::sim {
namespace {

using scene::driving;
using scene::meanBand;
using scene::meanOf;
using scene::rateBand;
using scene::sigmaBand;
using scene::sigmaOf;

constexpr double kSpacing = 40.0;
constexpr double kSpeed = 10.0;

/// `count` chambers every 40 m, 3 m beside the way, the first at x = 40.
PassageConfig chambers(int count) {
  PassageConfig config;
  config.sigma = 0.0;
  for (int i = 1; i <= count; ++i) {
    config.places.push_back({.name = "chamber " + std::to_string(i), .p_map = {kSpacing * i, 3.0, 0.0}});
  }
  return config;
}

/// Past all of them along x at 10 m/s.
std::shared_ptr<const Motion> pastAll(int count) {
  return driving({0, 0, 0}, {kSpeed, 0, 0}, (kSpacing * count + 30.0) / kSpeed);
}

std::vector<Delivery> fixes(const PassageConfig& config, std::shared_ptr<const Motion> motion,
                            std::uint64_t seed = 1) {
  PassageStream stream(config, std::move(motion), {.seed = seed});
  return scene::drained(stream);
}

const PassageFix& fixOf(const Delivery& delivery) {
  return std::get<PassageFix>(delivery.measurement.reading);
}

/// There and back along x: 20 s at 5 m/s, then the same way back.
class Shuttle : public scene::PlainMotion {
 public:
  Shuttle() : PlainMotion(40.0) {}
  Kinematics at(double t) const override {
    Kinematics k;
    k.p_map.x() = t < 20.0 ? 5.0 * t : 200.0 - 5.0 * t;
    k.v_map.x() = t < 20.0 ? 5.0 : -5.0;
    return k;
  }
  double travelled(double t) const override { return at(t).p_map.x(); }
};

}  // namespace

TEST(PassageStream, EveryPassageGivesOneFixAtTheNearestMoment) {
  PassageConfig config = chambers(5);
  config.antenna_body = {1.5, 0.0, 0.0};
  const std::vector<Delivery> all = fixes(config, pastAll(5));
  ASSERT_EQ(all.size(), 5U);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_FALSE(defect(all[i].measurement));
    EXPECT_EQ(fixOf(all[i]).place, config.places[i].name);
    EXPECT_TRUE(fixOf(all[i]).p_map.isApprox(config.places[i].p_map));
    EXPECT_EQ(fixOf(all[i]).p_body, config.antenna_body);
    EXPECT_NEAR(scene::secondsOf(all[i]), (config.places[i].p_map.x() - 1.5) / kSpeed, 1e-5);
    EXPECT_GT(all[i].arrival, all[i].measurement.stamp);  // known only once it is past
  }
}

TEST(PassageStream, EveryVisitCountsAlsoOnTheWayBack) {
  PassageConfig config;
  config.places = {{.name = "chamber", .p_map = {50.0, 2.0, 0.0}}};
  const std::vector<Delivery> all = fixes(config, std::make_shared<Shuttle>());
  ASSERT_EQ(all.size(), 2U);
  EXPECT_NEAR(scene::secondsOf(all[0]), 10.0, 1e-5);
  EXPECT_NEAR(scene::secondsOf(all[1]), 30.0, 1e-5);
}

TEST(PassageStream, RunThatStartsAbeamHasNoClosestApproach) {
  PassageConfig config;
  config.places = {{.name = "start", .p_map = {0.0, 2.0, 0.0}}};
  EXPECT_TRUE(fixes(config, driving({0, 0, 0}, {kSpeed, 0, 0}, 20.0)).empty());
}

TEST(PassageStream, ErrorsAlongTheWayHaveTheirSigmasAndAreReported) {
  PassageConfig config = chambers(10);
  config.sigma = 0.3;
  config.sigma_time = 0.02;
  std::vector<double> along;
  std::vector<double> timing;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    for (const Delivery& delivery : fixes(config, pastAll(10), seed)) {
      const PassageFix& fix = fixOf(delivery);
      const double place = kSpacing * std::round(fix.p_map.x() / kSpacing);
      along.push_back(fix.p_map.x() - place);
      timing.push_back(scene::secondsOf(delivery) - place / kSpeed);
      EXPECT_NEAR(fix.covariance(0, 0), 0.09 + 0.04, 1e-9);  // 10 m/s * 0.02 s = 0.2 m
      EXPECT_NEAR(fix.covariance(1, 1), 4.0, 1e-9);
    }
  }
  EXPECT_EQ(along.size(), 3000U);
  EXPECT_NEAR(meanOf(along), 0.0, meanBand(0.3, along.size()));
  EXPECT_NEAR(sigmaOf(along), 0.3, sigmaBand(0.3, along.size()));
  EXPECT_NEAR(meanOf(timing), 0.0, meanBand(0.02, timing.size()));
  EXPECT_NEAR(sigmaOf(timing), 0.02, sigmaBand(0.02, timing.size()));
}

TEST(PassageStream, MissesAndMistakesTheGivenShares) {
  PassageConfig config = chambers(10);
  config.missed_probability = 0.10;
  config.wrong_probability = 0.05;
  constexpr std::size_t kSeeds = 600;
  std::size_t heard = 0;
  std::size_t wrong = 0;
  std::map<std::string, int> wrongly;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    for (const Delivery& delivery : fixes(config, pastAll(10), seed)) {
      ++heard;
      const auto truly =
          static_cast<std::size_t>(std::lround(scene::secondsOf(delivery) * kSpeed / kSpacing)) - 1;
      if (fixOf(delivery).place == config.places[truly].name) continue;
      ++wrong;
      wrongly[fixOf(delivery).place] += 1;
      EXPECT_GT((fixOf(delivery).p_map - config.places[truly].p_map).norm(), 0.9 * kSpacing);
    }
  }
  const std::size_t passed = 10 * kSeeds;
  EXPECT_NEAR(static_cast<double>(heard) / static_cast<double>(passed), 0.9, rateBand(0.1, passed));
  EXPECT_NEAR(static_cast<double>(wrong) / static_cast<double>(heard), 0.05, rateBand(0.05, heard));
  EXPECT_EQ(wrongly.size(), 10U);  // any other place may be named
}

TEST(PassageStream, ReaderReadsAnywhereWithinItsRadius) {
  PassageConfig config = chambers(10);
  config.style = PassageStyle::Reader;
  config.radius = 3.0;
  config.timing.rate = 200.0;
  for (PassagePlace& place : config.places) place.p_map.y() = 0.0;
  std::vector<double> off;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    for (const Delivery& delivery : fixes(config, pastAll(10), seed)) {
      off.push_back(kSpeed * scene::secondsOf(delivery) - fixOf(delivery).p_map.x());
      EXPECT_NEAR(fixOf(delivery).covariance(0, 0), 3.0, 1e-9);
    }
  }
  EXPECT_EQ(off.size(), 2000U);
  const double sigma = 3.0 / std::sqrt(3.0);
  const double look = kSpeed / 200.0;  // a read waits for the next look: up to 5 cm late
  EXPECT_NEAR(meanOf(off), 0.5 * look, meanBand(sigma, off.size()) + 0.5 * look);
  // The square of a uniform value has variance 4/45 of the fourth power of its limit: sigma's own sigma is
  // 0.447 sigma / sqrt(n).
  EXPECT_NEAR(sigmaOf(off), sigma, scene::kBand * 0.447 * sigma / std::sqrt(2000.0) + look);
}

TEST(PassageStream, ReaderReadsAVehicleThatStandsAtThePlace) {
  PassageConfig config;
  config.style = PassageStyle::Reader;
  config.places = {{.name = "chamber", .p_map = {1.0, 0.0, 0.0}}};
  const std::vector<Delivery> all = fixes(config, scene::standing({0, 0, 0}, 60.0));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(scene::secondsOf(all[0]), 0.0);
}

TEST(PassageStream, OutageSwallowsTheFixesRecognisedInIt) {
  PassageConfig config = chambers(5);
  config.timing.outages = {{7.5, 8.5}};  // the second chamber is passed at 8.0 s
  const std::vector<Delivery> all = fixes(config, pastAll(5));
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(fixOf(all[1]).place, "chamber 3");
}

TEST(PassageStream, SameSeedSameBytes) {
  PassageConfig config = chambers(20);
  config.sigma = 0.3;
  config.missed_probability = 0.2;
  const std::string first = scene::spelled(fixes(config, pastAll(20)));
  EXPECT_EQ(first, scene::spelled(fixes(config, pastAll(20))));
  EXPECT_NE(first, scene::spelled(fixes(config, pastAll(20), 2)));
}

TEST(PassageStream, RefusesPlacesThatCannotBe) {
  PassageConfig config = chambers(2);
  config.places[1].name = config.places[0].name;
  EXPECT_THROW((void)validated(config), ConfigError);
  config = chambers(1);
  config.wrong_probability = 0.1;
  EXPECT_THROW((void)validated(config), ConfigError);
  EXPECT_THROW((void)validated(PassageConfig{}), ConfigError);
}

}  // namespace pos::sim
