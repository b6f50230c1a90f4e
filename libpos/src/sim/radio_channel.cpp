#include "radio_channel.hpp"

#include <algorithm>
#include <cmath>

namespace pos::sim {
namespace {

enum Kind : std::uint32_t { kSpread = 1, kFaults = 2, kRock = 3, kProcess = 4, kBlocks = 5, kEpisodes = 6 };

double exponential(double mean, RandomStream& random) {
  return -mean * std::log(random.uniform());
}

}  // namespace

RandomStream linkRandom(const RunSetup& run, const Timing& timing, std::uint32_t kind, std::size_t number) {
  return randomStream(run, timing, (kind << 20U) | static_cast<std::uint32_t>(number));
}

HidingProcess::HidingProcess(const NlosProcess& law, RandomStream random) : law_(law), random_(random) {
  now_.hidden = !random_.bernoulli(law_.mean_hidden / (law_.mean_hidden + law_.mean_free));
  turn();  // into the stationary state; what is left of an exponential spell is as long as a new one
}

void HidingProcess::turn() {
  now_ = now_.hidden ? Hiding{} : Hiding{.hidden = true, .bias = drawn(law_.bias, random_)};
  until_ += exponential(now_.hidden ? law_.mean_hidden : law_.mean_free, random_);
}

Hiding HidingProcess::at(double t) {
  while (t >= until_) turn();
  return now_;
}

Hiding HidingBlocks::at(double t) {
  const auto wanted = static_cast<std::int64_t>(std::floor(t / law_.period));
  while (block_ < wanted) {
    ++block_;
    const bool hidden = random_.bernoulli(law_.probability);
    const double bias = drawn(law_.bias, random_);
    now_ = hidden ? Hiding{.hidden = true, .bias = bias} : Hiding{};
  }
  return now_;
}

RadioChannel::RadioChannel(const UwbConfig& config, const std::vector<map::Anchor>& anchors,
                           const RunSetup& run, LineOfSight line_of_sight)
    : errors_(config.errors), line_of_sight_(std::move(line_of_sight)) {
  for (const Tag& tag : config.tags) tags_.push_back(tag.id);
  for (const map::Anchor& anchor : anchors) anchors_.push_back(anchor.id);
  for (std::size_t tag = 0; tag < tags_.size(); ++tag) {
    for (std::size_t anchor = 0; anchor < anchors_.size(); ++anchor) {
      links_.push_back(newLink(tag, anchor, config, run));
    }
  }
  states_.resize(anchors_.size());
  for (std::size_t a = 0; a < anchors_.size(); ++a) {
    if (errors_.process) {
      states_[a].process.emplace_back(*errors_.process, linkRandom(run, config.timing, kProcess, a));
    }
    if (errors_.blocks) {
      states_[a].blocks.emplace_back(*errors_.blocks, linkRandom(run, config.timing, kBlocks, a));
    }
  }
  for (std::size_t e = 0; e < errors_.episodes.size(); ++e) {
    RandomStream random = linkRandom(run, config.timing, kEpisodes, e);
    episode_bias_.push_back(drawn(errors_.episodes[e].bias, random));
  }
}

RadioChannel::Link RadioChannel::newLink(std::size_t tag, std::size_t anchor, const UwbConfig& config,
                                         const RunSetup& run) const {
  const std::size_t n = number(tag, anchor);
  RandomStream random = linkRandom(run, config.timing, kSpread, n);
  const LinkSpread& spread = errors_.spread;
  const double scale = random.uniform(spread.scale_low, spread.scale_high);
  const double offset = random.uniform(spread.offset_low, spread.offset_high);
  Link link{.scale = scale,
            .offset = offset,
            .faults = linkRandom(run, config.timing, kFaults, n),
            .rock = linkRandom(run, config.timing, kRock, n)};
  for (const LinkError& error : errors_.links) {
    if (error.tag.value_or(tags_[tag]) != tags_[tag] ||
        error.anchor.value_or(anchors_[anchor]) != anchors_[anchor])
      continue;
    link.scale += error.scale;
    link.offset += error.offset;
  }
  return link;
}

Hiding RadioChannel::anchorHiding(std::size_t anchor, double t) {
  Hiding hiding;
  for (HidingProcess& process : states_[anchor].process) {
    if (const Hiding now = process.at(t); now.hidden) hiding.add(now.bias);
  }
  for (HidingBlocks& blocks : states_[anchor].blocks) {
    if (const Hiding now = blocks.at(t); now.hidden) hiding.add(now.bias);
  }
  for (std::size_t e = 0; e < errors_.episodes.size(); ++e) {
    const NlosEpisode& episode = errors_.episodes[e];
    if (episode.anchor == anchors_[anchor] && episode.when.contains(t)) hiding.add(episode_bias_[e]);
  }
  return hiding;
}

void RadioChannel::rock(Link& link, bool clear, Path& path, Hiding& hiding) {
  if (!clear && !link.behind_rock) link.rock_bias = drawn(errors_.obstruction.bias, link.rock);
  link.behind_rock = !clear;
  if (clear) return;
  if (errors_.obstruction.effect == Obstruction::Effect::Lost) path.heard = false;
  hiding.add(link.rock_bias);
}

bool RadioChannel::silenced(std::size_t tag, std::size_t anchor, double t) const {
  return std::any_of(errors_.silences.begin(), errors_.silences.end(), [&](const AnchorSilence& silence) {
    return silence.anchor == anchors_[anchor] && silence.tag.value_or(tags_[tag]) == tags_[tag] &&
           silence.when.contains(t);
  });
}

RadioChannel::Path RadioChannel::path(std::size_t tag, std::size_t anchor, double t,
                                      const Eigen::Vector3d& tag_map, const Eigen::Vector3d& anchor_map) {
  Link& link = links_[number(tag, anchor)];
  Path path{.heard = !silenced(tag, anchor, t)};
  Hiding hiding = anchorHiding(anchor, t);
  rock(link, !line_of_sight_ || line_of_sight_(tag_map, anchor_map), path, hiding);

  const bool dropped = link.faults.bernoulli(errors_.drop_probability);
  const bool echo = link.faults.bernoulli(errors_.multipath.probability);
  const double echo_excess = drawn(errors_.multipath.excess, link.faults);
  const bool outlier = link.faults.bernoulli(errors_.outliers.probability);
  const bool too_short = link.faults.bernoulli(errors_.outliers.short_share);
  const double outlier_size = drawn(errors_.outliers.size, link.faults);

  path.heard = path.heard && !dropped;
  path.hidden = hiding.hidden;
  path.excess =
      hiding.bias + (echo ? echo_excess : 0.0) + (outlier ? (too_short ? -1.0 : 1.0) * outlier_size : 0.0);
  return path;
}

double RadioChannel::distorted(std::size_t tag, std::size_t anchor, double range) const {
  const Link& link = links_[number(tag, anchor)];
  return (1.0 + link.scale) * range + link.offset;
}

}  // namespace pos::sim
