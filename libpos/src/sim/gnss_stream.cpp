#include "pos/sim/gnss_stream.hpp"

#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::sim {
namespace {

void check(const GnssZone& zone, const std::string& key) {
  (void)validated(zone.where, key);
  requireNotNegative(zone.sigma.first, key + ".sigma.first", "m");
  requireNotNegative(zone.sigma.last, key + ".sigma.last", "m");
  require(zone.sigma.first == zone.sigma.last || (zone.sigma.first > 0.0 && zone.sigma.last > 0.0),
          key + ".sigma", "two positive values, or two equal ones");
  requireNotNegative(zone.vertical_factor, key + ".vertical_factor", "-");
  require(zone.bias.allFinite(), key + ".bias", "three numbers, m");
}

}  // namespace

GnssConfig validated(GnssConfig config) {
  const std::string& key = config.sensor;
  requireValid(config.timing, key + ".timing");
  require(config.antenna_body.allFinite(), key + ".antenna_body", "three numbers, m");
  require(!config.zones.empty(), key + ".zones", "at least one zone; without one there are no fixes");
  for (const GnssZone& zone : config.zones) check(zone, key + ".zones[" + zone.where.name + "]");
  requireNotNegative(config.correlation_time, key + ".correlation_time", "s");
  requireNotNegative(config.stale, key + ".stale", "s");
  if (config.claimed_sigma) requirePositive(*config.claimed_sigma, key + ".claimed_sigma", "m");
  require(std::abs(config.origin.latitude) < 0.5 * kPi, key + ".origin.latitude", "between the poles, rad");
  return config;
}

GnssStream::GnssStream(const GnssConfig& config, std::shared_ptr<const Motion> motion, const RunSetup& run)
    : config_(validated(config)),
      motion_(std::move(motion)),
      frame_(config_.origin),
      ticker_(config_.timing, run, motion_->duration()),
      noise_(randomStream(run, config_.timing, Ticker::kFirstPurpose)) {}

std::optional<std::size_t> GnssStream::zoneAt(double t, const Eigen::Vector3d& p_map) const {
  for (std::size_t i = 0; i < config_.zones.size(); ++i) {
    if (!config_.zones[i].where.contains(t, p_map.head<2>())) continue;
    return config_.zones[i].masked ? std::nullopt : std::optional(i);
  }
  return {};
}

/// First-order Gauss-Markov of unit variance; white when the correlation time is zero.
void GnssStream::advanceError(double t) {
  const bool white = !error_t_ || config_.correlation_time == 0.0;
  const double kept = white ? 0.0 : std::exp(-(t - *error_t_) / config_.correlation_time);
  error_ = kept * error_ + std::sqrt(1.0 - kept * kept) * normals(noise_);
  error_t_ = t;
}

GnssStream::Claim GnssStream::claim(double t, std::size_t zone, const Claim& honest) {
  if (zone_ && *zone_ != zone) stale_until_ = t + config_.stale;
  const bool stale = zone_ && t < stale_until_;
  zone_ = zone;
  if (!stale) last_claim_ = honest;
  return last_claim_;
}

GnssFix GnssStream::fix(const Eigen::Vector3d& p_map, const Claim& said) const {
  const map::GeodeticOrigin point = frame_.toGeodetic(p_map);
  GnssFix fix{.latitude = point.latitude, .longitude = point.longitude, .altitude = point.altitude};
  fix.covariance_enu.diagonal() << said.sigma * said.sigma, said.sigma * said.sigma,
      said.sigma_up * said.sigma_up;
  fix.quality = said.quality;
  return fix;
}

std::optional<Delivery> GnssStream::next() {
  while (const std::optional<Tick> tick = ticker_.next()) {
    advanceError(tick->t);
    const Kinematics body = motion_->at(tick->t);
    const Eigen::Vector3d antenna = body.p_map + body.R_map_body * config_.antenna_body;
    const std::optional<std::size_t> index = zoneAt(tick->t, antenna);
    if (!index) {
      zone_.reset();
      stale_until_ = 0.0;
    }
    if (!index || tick->lost) continue;

    const GnssZone& zone = config_.zones[*index];
    const double sigma = zone.sigma.at(zone.where.progress(tick->t, antenna.head<2>()));
    const double told = config_.claimed_sigma.value_or(sigma);
    const Claim said = claim(tick->t, *index, {told, told * zone.vertical_factor, zone.quality});
    const Eigen::Vector3d sigmas(sigma, sigma, sigma * zone.vertical_factor);
    const Eigen::Vector3d found = antenna + zone.bias + sigmas.cwiseProduct(error_);
    return ticker_.sent(tick->t, config_.sensor, fix(found, said));
  }
  return {};
}

}  // namespace pos::sim
