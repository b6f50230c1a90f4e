#include "pos/sim/gnss_stream.hpp"

#include <gtest/gtest.h>

#include "pos/core/error.hpp"
#include "sensor_scene.hpp"

namespace pos::sim {
namespace {

using scene::driving;
using scene::meanBand;
using scene::meanOf;
using scene::sigmaBand;
using scene::sigmaOf;
using scene::standing;

const map::GeodeticOrigin kOrigin{.latitude = 0.6, .longitude = 1.9, .altitude = 120.0, .grid_rotation = 0.3};

GnssConfig plain() {
  GnssConfig config;
  config.origin = kOrigin;
  config.zones = {GnssZone{}};
  return config;
}

struct Fix {
  double t = 0.0;
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  double sigma = 0.0;     // claimed
  double sigma_up = 0.0;  // claimed
  GnssFix::Quality quality = GnssFix::Quality::None;
};

std::vector<Fix> fixes(const GnssConfig& config, std::shared_ptr<const Motion> motion,
                       std::uint64_t seed = 1) {
  GnssStream stream(config, std::move(motion), {.seed = seed});
  std::vector<Fix> all;
  while (const std::optional<Delivery> delivery = stream.next()) {
    EXPECT_FALSE(defect(delivery->measurement));
    const auto& fix = std::get<GnssFix>(delivery->measurement.reading);
    const Eigen::Vector3d p =
        map::LocalFrame(kOrigin).fromGeodetic(fix.latitude, fix.longitude, fix.altitude);
    all.push_back({scene::secondsOf(*delivery), p, std::sqrt(fix.covariance_enu(0, 0)),
                   std::sqrt(fix.covariance_enu(2, 2)), fix.quality});
  }
  return all;
}

/// Errors of one axis of the fixes in [from, to), against a vehicle standing at the origin.
std::vector<double> axisErrors(const std::vector<Fix>& all, int axis, double from = 0.0, double to = 1e9) {
  std::vector<double> errors;
  for (const Fix& fix : all) {
    if (fix.t >= from && fix.t < to) errors.push_back(fix.p_map[axis]);
  }
  return errors;
}

/// Spec B A8.2 by time, stretched so that statistics bite.
GnssConfig surfaceToUnderground() {
  GnssConfig config = plain();
  config.zones = {{.where = {.name = "surface", .time = TimeSpan{0.0, 1000.0}}, .sigma = {0.02, 0.02}},
                  {.where = {.name = "portal", .time = TimeSpan{1000.0, 2000.0}},
                   .sigma = {1.0, 1.0},
                   .vertical_factor = 1.5,
                   .quality = GnssFix::Quality::Autonomous},
                  {.where = {.name = "drift", .time = TimeSpan{2000.0, 2500.0}}, .masked = true},
                  {.where = {.name = "residual"}, .sigma = {3.0, 3.0}, .bias = {4.0, -3.0, 0.0}}};
  return config;
}

}  // namespace

TEST(GnssStream, WithoutNoiseFixesAreTheAntennaInTheMap) {
  GnssConfig config = plain();
  config.zones[0].sigma = {0.0, 0.0};
  config.antenna_body = {0.5, 0.2, 2.0};
  const Eigen::Quaterniond q(Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitZ()));
  for (const Fix& fix : fixes(config, std::make_shared<scene::Posed>(Eigen::Vector3d(30, -20, 5), q, 1.0))) {
    const Eigen::Vector3d antenna = Eigen::Vector3d(30, -20, 5) + q * config.antenna_body;
    EXPECT_LT((fix.p_map - antenna).norm(), 1e-6);
  }
}

TEST(GnssStream, EveryZoneHasItsSigmaBiasAndQuality) {
  const std::vector<Fix> all = fixes(surfaceToUnderground(), standing({0, 0, 0}, 4000.0));
  const std::vector<double> surface = axisErrors(all, 0, 0.0, 1000.0);
  const std::vector<double> portal = axisErrors(all, 1, 1000.0, 2000.0);
  const std::vector<double> portal_up = axisErrors(all, 2, 1000.0, 2000.0);
  const std::vector<double> residual = axisErrors(all, 0, 2500.0);
  EXPECT_NEAR(sigmaOf(surface), 0.02, sigmaBand(0.02, surface.size()));
  EXPECT_NEAR(meanOf(surface), 0.0, meanBand(0.02, surface.size()));
  EXPECT_NEAR(sigmaOf(portal), 1.0, sigmaBand(1.0, portal.size()));
  EXPECT_NEAR(sigmaOf(portal_up), 1.5, sigmaBand(1.5, portal_up.size()));
  EXPECT_TRUE(axisErrors(all, 0, 2000.0, 2500.0).empty());
  EXPECT_NEAR(meanOf(residual), 4.0, meanBand(3.0, residual.size()));
  EXPECT_NEAR(sigmaOf(residual), 3.0, sigmaBand(3.0, residual.size()));
  for (const Fix& fix : all) {
    const bool portal_time = fix.t >= 1000.0 && fix.t < 2000.0;
    EXPECT_EQ(fix.quality, portal_time ? GnssFix::Quality::Autonomous : GnssFix::Quality::RtkFixed);
    EXPECT_NEAR(fix.sigma, fix.t < 1000.0 ? 0.02 : portal_time ? 1.0 : 3.0, 1e-12);
  }
}

// Spec B A8.2, the default of the Table 5 comparison: R stays at 2 cm for 1 s after the change.
TEST(GnssStream, StaleCovarianceLagsTheChangeByItsTime) {
  GnssConfig config = surfaceToUnderground();
  config.stale = 1.0;
  for (const Fix& fix : fixes(config, standing({0, 0, 0}, 2600.0))) {
    const double honest = fix.t < 1000.0 ? 0.02 : fix.t < 2000.0 ? 1.0 : 3.0;
    const bool stale = fix.t >= 1000.0 && fix.t < 1001.0 - 1e-6;
    EXPECT_NEAR(fix.sigma, stale ? 0.02 : honest, 1e-12) << fix.t;  // no lag across the masked zone
    EXPECT_EQ(fix.quality == GnssFix::Quality::Autonomous, fix.t >= 1001.0 - 1e-6 && fix.t < 2000.0) << fix.t;
  }
}

// Spec B A8.3: 0.02 m growing log-linearly to 1.0 m over the incline, x = 11 to 27, then nothing.
TEST(GnssStream, SigmaGrowsLogLinearlyDownTheInclineByPlace) {
  const Outline incline{{11, -2}, {27, -2}, {27, 2}, {11, 2}};
  const Outline surface{{-5, -2}, {11, -2}, {11, 2}, {-5, 2}};
  GnssConfig config = plain();
  config.timing.rate = 100.0;
  config.zones = {{.where = {.name = "surface", .place = surface}, .sigma = {0.02, 0.02}},
                  {.where = {.name = "incline",
                             .place = incline,
                             .ramp_from = Eigen::Vector2d(11, 0),
                             .ramp_to = Eigen::Vector2d(27, 0)},
                   .sigma = {0.02, 1.0}}};
  const std::vector<Fix> all = fixes(config, driving({0, 0, 0}, {0.01, 0, 0}, 4000.0));
  std::vector<double> normalised;
  for (const Fix& fix : all) {
    const double x = 0.01 * fix.t;
    ASSERT_LT(x, 27.0);
    const double sigma = x < 11.0 ? 0.02 : 0.02 * std::pow(50.0, (x - 11.0) / 16.0);
    EXPECT_NEAR(fix.sigma, sigma, 1e-9);
    normalised.push_back(fix.p_map.y() / sigma);
  }
  EXPECT_NEAR(all.back().sigma, 1.0, 1e-3);
  EXPECT_NEAR(sigmaOf(normalised), 1.0, sigmaBand(1.0, normalised.size()));
}

TEST(GnssStream, CorrelatedErrorsKeepTheirSigmaAndForgetInTheirTime) {
  GnssConfig config = plain();
  config.timing.rate = 1.0;
  config.zones[0].sigma = {1.0, 1.0};
  config.correlation_time = 20.0;
  const std::vector<double> x = axisErrors(fixes(config, standing({0, 0, 0}, 40000.0)), 0);
  double product = 0.0;
  for (std::size_t i = 1; i < x.size(); ++i) product += x[i] * x[i - 1];
  // Samples 2 tau apart count as one; the lag-one product of a Gauss-Markov series has variance (1 - a^2) /
  // n.
  const double a = std::exp(-1.0 / 20.0);
  const std::size_t independent = x.size() / 40;
  EXPECT_NEAR(sigmaOf(x), 1.0, 1.5 * sigmaBand(1.0, independent));
  const double correlation = product / static_cast<double>(x.size()) / (sigmaOf(x) * sigmaOf(x));
  EXPECT_NEAR(correlation, a, scene::kBand * std::sqrt((1.0 - a * a) / static_cast<double>(x.size())));
}

TEST(GnssStream, ClaimedSigmaReplacesTheTrueOneInTheReport) {
  GnssConfig config = surfaceToUnderground();
  config.claimed_sigma = 0.3;
  for (const Fix& fix : fixes(config, standing({0, 0, 0}, 1500.0))) EXPECT_NEAR(fix.sigma, 0.3, 1e-12);
}

TEST(GnssStream, OutsideAllZonesThereIsNoFix) {
  GnssConfig config = plain();
  config.zones[0].where.time = TimeSpan{5.0, 6.0};
  EXPECT_EQ(fixes(config, standing({0, 0, 0}, 100.0)).size(), 10U);
}

TEST(GnssStream, SameSeedSameBytes) {
  const auto motion = standing({0, 0, 0}, 50.0);
  GnssStream a(plain(), motion, {.seed = 1});
  GnssStream b(plain(), motion, {.seed = 1});
  GnssStream c(plain(), motion, {.seed = 2});
  const std::string first = scene::spelled(scene::drained(a));
  EXPECT_EQ(first, scene::spelled(scene::drained(b)));
  EXPECT_NE(first, scene::spelled(scene::drained(c)));
}

TEST(GnssStream, RefusesASetUpThatCannotWork) {
  GnssConfig config = plain();
  config.zones.clear();
  EXPECT_THROW((void)validated(config), ConfigError);
  config = plain();
  config.zones[0].sigma = {0.0, 1.0};
  EXPECT_THROW((void)validated(config), ConfigError);
}

}  // namespace pos::sim
