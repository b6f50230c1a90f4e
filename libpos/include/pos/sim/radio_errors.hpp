#pragma once
/// What can be wrong with a radio range beyond its noise. Lengths in m, times in s since the start.

#include <optional>
#include <string>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/sim/bias_law.hpp"
#include "pos/sim/zone.hpp"

namespace pos::sim {

/// measured = (1 + scale) true + offset, on the links named; an absent tag or anchor means all. Entries that
/// name the same link add up.
struct LinkError {
  std::optional<TagId> tag = {};
  std::optional<AnchorId> anchor = {};
  double scale = 0.0;   ///< -
  double offset = 0.0;  ///< m
};

/// One scale and one offset drawn per link (tag and anchor) for the whole run, uniform between the limits.
struct LinkSpread {
  double scale_low = 0.0;    ///< -
  double scale_high = 0.0;   ///< -
  double offset_low = 0.0;   ///< m
  double offset_high = 0.0;  ///< m
};

/// Excess of a single range, independent of the others.
struct Multipath {
  double probability = 0.0;
  BiasLaw excess = BiasLaw::uniform(0.0, 3.0);
};

/// Gross errors of both signs.
struct Outliers {
  double probability = 0.0;
  double short_share = 0.5;  ///< fraction of them that are too short
  BiasLaw size = BiasLaw::uniform(2.0, 20.0);
};

/// Hidden and free spells of one anchor, each exponentially long: a two-state Markov process, begun in its
/// stationary state. The bias is drawn once a hidden spell.
struct NlosProcess {
  double mean_free = 10.0;   ///< s
  double mean_hidden = 1.0;  ///< s
  BiasLaw bias = BiasLaw::uniform(0.3, 1.5);
};

/// In every block of `period` an anchor is hidden with `probability`, whatever it was before; one bias a
/// block (spec B A8.1, the default of its circle run).
struct NlosBlocks {
  double probability = 0.15;
  double period = 0.5;  ///< s
  BiasLaw bias = BiasLaw::uniform(0.3, 1.5);
};

/// One anchor hidden for a while (spec A 3.5, A4); one bias an episode.
struct NlosEpisode {
  AnchorId anchor = 0;
  TimeSpan when = {};
  BiasLaw bias = BiasLaw::uniform(0.3, 1.5);
};

/// What happens to a range whose straight line the rock cuts.
struct Obstruction {
  enum class Effect { Lost, Delayed } effect = Effect::Lost;
  BiasLaw bias = BiasLaw::uniform(0.3, 1.5);  ///< Delayed: drawn once each time the link becomes hidden
};

/// No ranges to this anchor (from one tag, or from all) for a while.
struct AnchorSilence {
  AnchorId anchor = 0;
  std::optional<TagId> tag = {};
  TimeSpan when = {};
};

/// Received power by log-distance path loss. P = power_at_1m - 10 exponent log10(d / 1 m); the first path is
/// `first_path_gap` below. A hidden link loses `hidden_loss` of the total and `hidden_first_path_loss` more
/// of the first path. Both get normal noise of `sigma` dB.
struct RadioPower {
  double power_at_1m = -63.0;            ///< dBm
  double exponent = 2.0;                 ///< -
  double first_path_gap = 2.0;           ///< dB
  double hidden_loss = 6.0;              ///< dB
  double hidden_first_path_loss = 10.0;  ///< dB
  double sigma = 1.0;                    ///< dB
};

/// Noise in a zone; with `silent`, no ranges there at all.
struct RangeZone {
  Zone where = {};
  SigmaRamp sigma = {};
  bool silent = false;
};

/// All of it. When several causes hide a link at once, the largest bias counts.
struct RadioErrors {
  double drop_probability = 0.0;  ///< of any single range
  std::vector<LinkError> links = {};
  LinkSpread spread = {};
  Multipath multipath = {};
  Outliers outliers = {};
  std::optional<NlosProcess> process = {};
  std::optional<NlosBlocks> blocks = {};
  std::vector<NlosEpisode> episodes = {};
  Obstruction obstruction = {};
  std::vector<AnchorSilence> silences = {};
};

/// Throws ConfigError naming `key` and the first field that cannot be.
RadioErrors validated(RadioErrors errors, const std::string& key);

}  // namespace pos::sim
