#include <set>

#include "pos/core/config_checks.hpp"
#include "pos/sim/uwb_stream.hpp"

namespace pos::sim {
namespace {

void check(const RangeZone& zone, const std::string& key) {
  (void)validated(zone.where, key);
  requireNotNegative(zone.sigma.first, key + ".sigma.first", "m");
  requireNotNegative(zone.sigma.last, key + ".sigma.last", "m");
  require(zone.sigma.first == zone.sigma.last || (zone.sigma.first > 0.0 && zone.sigma.last > 0.0),
          key + ".sigma", "two positive values, or two equal ones");
}

void checkTags(const UwbConfig& config) {
  require(!config.tags.empty(), config.sensor + ".tags", "at least one tag");
  std::set<TagId> ids;
  for (const Tag& tag : config.tags) {
    require(ids.insert(tag.id).second, config.sensor + ".tags", "every tag id once");
    require(tag.tag_body.allFinite(), config.sensor + ".tags.tag_body", "three numbers, m");
    requireNotNegative(tag.delay, config.sensor + ".tags.delay", "s");
  }
}

}  // namespace

UwbConfig validated(UwbConfig config) {
  const std::string& key = config.sensor;
  requireValid(config.timing, key + ".timing");
  (void)validated(config.two_way, key + ".two_way");
  (void)validated(config.errors, key + ".errors");
  checkTags(config);
  requirePositive(config.schedule.slot, key + ".schedule.slot", "s");
  requireNotNegative(config.sigma, key + ".sigma", "m");
  requireNotNegative(config.sigma_z, key + ".sigma_z", "m");
  requirePositive(config.range_max, key + ".range_max", "m");
  requireNotNegative(config.survey_error, key + ".survey_error", "sigmas");
  requireNotNegative(config.devices.antenna_delay, key + ".devices.antenna_delay", "s");
  requireNotNegative(config.devices.antenna_delay_sigma, key + ".devices.antenna_delay_sigma", "s");
  require(config.devices.rate_error_max >= 0.0 && config.devices.rate_error_max < 1e-2,
          key + ".devices.rate_error_max", "0 to 0.01");
  if (config.claimed_sigma) requirePositive(*config.claimed_sigma, key + ".claimed_sigma", "m");
  if (config.power) requireNotNegative(config.power->sigma, key + ".power.sigma", "dB");
  for (const RangeZone& zone : config.zones) check(zone, key + ".zones");
  return config;
}

}  // namespace pos::sim
