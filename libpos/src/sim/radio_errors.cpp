#include "pos/sim/radio_errors.hpp"

#include <cmath>

#include "pos/core/config_checks.hpp"

namespace pos::sim {
namespace {

void check(const LinkError& link, const std::string& key) {
  requireFinite(link.offset, key + ".offset", "m");
  require(link.scale > -1.0 && std::isfinite(link.scale), key + ".scale", "> -1");
}

void check(const LinkSpread& spread, const std::string& key) {
  require(
      spread.scale_low > -1.0 && spread.scale_high >= spread.scale_low && std::isfinite(spread.scale_high),
      key + ".scale", "low above -1, high not below low");
  require(std::isfinite(spread.offset_low) && spread.offset_high >= spread.offset_low &&
              std::isfinite(spread.offset_high),
          key + ".offset", "high not below low, m");
}

}  // namespace

RadioErrors validated(RadioErrors errors, const std::string& key) {
  requireShare(errors.drop_probability, key + ".drop_probability");
  for (const LinkError& link : errors.links) check(link, key + ".links");
  check(errors.spread, key + ".spread");
  requireShare(errors.multipath.probability, key + ".multipath.probability");
  (void)validated(errors.multipath.excess, key + ".multipath.excess");
  requireShare(errors.outliers.probability, key + ".outliers.probability");
  requireShare(errors.outliers.short_share, key + ".outliers.short_share");
  (void)validated(errors.outliers.size, key + ".outliers.size");
  if (errors.process) {
    requirePositive(errors.process->mean_free, key + ".process.mean_free", "s");
    requirePositive(errors.process->mean_hidden, key + ".process.mean_hidden", "s");
    (void)validated(errors.process->bias, key + ".process.bias");
  }
  if (errors.blocks) {
    requireShare(errors.blocks->probability, key + ".blocks.probability");
    requirePositive(errors.blocks->period, key + ".blocks.period", "s");
    (void)validated(errors.blocks->bias, key + ".blocks.bias");
  }
  for (const NlosEpisode& episode : errors.episodes) {
    requireSpan(episode.when, key + ".episodes.when");
    (void)validated(episode.bias, key + ".episodes.bias");
  }
  (void)validated(errors.obstruction.bias, key + ".obstruction.bias");
  for (const AnchorSilence& silence : errors.silences) requireSpan(silence.when, key + ".silences.when");
  return errors;
}

}  // namespace pos::sim
