#include "pos/sim/uwb_stream.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "pos/core/config_checks.hpp"
#include "radio_channel.hpp"
#include "two_way_radios.hpp"

namespace pos::sim {
namespace {

enum Kind : std::uint32_t { kNoise = 32, kPower = 33, kTagNoise = 34, kSurvey = 35 };

/// One place in the cycle.
struct Slot {
  double delay = 0.0;  // s after the tick
  std::size_t tag = 0;
  std::size_t anchor = 0;
};

std::vector<Slot> slotsOf(const UwbConfig& config, std::size_t anchors) {
  std::vector<Slot> slots;
  const bool sequential = config.schedule.kind == RangeSchedule::Kind::Sequential;
  for (std::size_t tag = 0; tag < config.tags.size(); ++tag) {
    for (std::size_t anchor = 0; anchor < anchors; ++anchor) {
      const double wait = sequential ? config.schedule.slot * static_cast<double>(slots.size()) : 0.0;
      slots.push_back({.delay = wait + config.tags[tag].delay, .tag = tag, .anchor = anchor});
    }
  }
  std::stable_sort(slots.begin(), slots.end(),
                   [](const Slot& a, const Slot& b) { return a.delay < b.delay; });
  const double last = slots.empty() ? 0.0 : slots.back().delay;
  require(last < 1.0 / config.timing.rate, config.sensor + ".timing.rate",
          "a period that holds all slots and tag delays");
  return slots;
}

std::vector<RandomStream> streams(std::uint32_t kind, std::size_t count, const UwbConfig& config,
                                  const RunSetup& run) {
  std::vector<RandomStream> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back(linkRandom(run, config.timing, kind, i));
  return all;
}

/// Where the anchors truly stand.
std::vector<map::Anchor> displaced(std::vector<map::Anchor> anchors, const UwbConfig& config,
                                   const RunSetup& run) {
  std::vector<RandomStream> random = streams(kSurvey, anchors.size(), config, run);
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    anchors[i].p_map += config.survey_error * anchors[i].survey_sigma * normals(random[i]);
  }
  return anchors;
}

double totalPower(const RadioPower& law, double distance) {
  return law.power_at_1m - 10.0 * law.exponent * std::log10(std::max(distance, 0.1));
}

}  // namespace

struct UwbStream::State {
  UwbConfig config;
  std::shared_ptr<const Motion> motion;
  std::vector<map::Anchor> anchors;
  Ticker ticker;
  RadioChannel channel;
  TwoWayRadios radios;
  std::vector<Slot> slots;
  std::vector<RandomStream> noise;         // a link
  std::vector<RandomStream> power;         // a link
  std::vector<RandomStream> tag_noise;     // a tag
  std::vector<Eigen::Vector3d> tag_error;  // m, of the cycle under way
  std::deque<Delivery> ready = {};

  State(const UwbConfig& good, std::vector<map::Anchor> map_anchors, std::shared_ptr<const Motion> truth,
        const RunSetup& run, LineOfSight line_of_sight)
      : config(good),
        motion(std::move(truth)),
        anchors(displaced(std::move(map_anchors), config, run)),
        ticker(config.timing, run, motion->duration()),
        channel(config, anchors, run, std::move(line_of_sight)),
        radios(config, anchors.size(), run),
        slots(slotsOf(config, anchors.size())),
        noise(streams(kNoise, config.tags.size() * anchors.size(), config, run)),
        power(streams(kPower, config.tags.size() * anchors.size(), config, run)),
        tag_noise(streams(kTagNoise, config.tags.size(), config, run)),
        tag_error(config.tags.size(), Eigen::Vector3d::Zero()) {}

  Eigen::Vector3d tagMap(std::size_t tag, double t) const {
    const Kinematics body = motion->at(t);
    return body.p_map + body.R_map_body * config.tags[tag].tag_body;
  }
  /// Sigma of the moment, m; nothing where no radio works.
  std::optional<double> sigmaAt(double t) const;
  void cycle(const Tick& tick);
  void drawTagErrors(double sigma);
  void positions(const Tick& tick, std::optional<double> sigma);
  /// The link's delivery, or nothing. Takes the same random numbers either way.
  std::optional<BeaconRange> ranged(const Slot& slot, double t, double sigma);
  double undistorted(const Slot& slot, double t, const Eigen::Vector3d& tag_map, double excess);
};

std::optional<double> UwbStream::State::sigmaAt(double t) const {
  if (config.zones.empty()) return config.sigma;
  const Eigen::Vector2d p = motion->at(t).p_map.head<2>();
  for (const RangeZone& zone : config.zones) {
    if (!zone.where.contains(t, p)) continue;
    if (zone.silent) return {};
    return zone.sigma.at(zone.where.progress(t, p));
  }
  return config.sigma;
}

void UwbStream::State::drawTagErrors(double sigma) {
  for (std::size_t tag = 0; tag < tag_error.size(); ++tag) {
    RandomStream& random = tag_noise[tag];
    tag_error[tag].x() = random.normal(0.0, sigma);
    tag_error[tag].y() = random.normal(0.0, sigma);
    tag_error[tag].z() = random.normal(0.0, config.sigma_z);
  }
}

void UwbStream::State::cycle(const Tick& tick) {
  const std::optional<double> sigma = sigmaAt(tick.t);
  if (config.mode == RangeMode::TagNoise || config.mode == RangeMode::TagPosition) {
    drawTagErrors(sigma.value_or(0.0));
  }
  if (config.mode == RangeMode::TagPosition) return positions(tick, sigma);
  for (const Slot& slot : slots) {
    const double t = seconds(durationFromSeconds(tick.t + slot.delay));
    const std::optional<BeaconRange> reading = ranged(slot, t, sigma.value_or(0.0));
    if (reading && sigma && !tick.lost) ready.push_back(ticker.sent(t, config.sensor, *reading));
  }
}

void UwbStream::State::positions(const Tick& tick, std::optional<double> sigma) {
  if (!sigma || tick.lost) return;
  for (std::size_t tag = 0; tag < config.tags.size(); ++tag) {
    const double t = seconds(durationFromSeconds(tick.t + config.tags[tag].delay));
    PassageFix fix;
    fix.place = "tag " + std::to_string(config.tags[tag].id);
    fix.p_map = tagMap(tag, t) + tag_error[tag];
    const double reported = config.claimed_sigma.value_or(*sigma);
    fix.covariance.diagonal() << reported * reported, reported * reported, config.sigma_z * config.sigma_z;
    ready.push_back(ticker.sent(t, config.sensor, fix));
  }
}

double UwbStream::State::undistorted(const Slot& slot, double t, const Eigen::Vector3d& tag_map,
                                     double excess) {
  const Eigen::Vector3d& anchor = anchors[slot.anchor].p_map;
  if (config.mode == RangeMode::TagNoise) return (tag_map + tag_error[slot.tag] - anchor).norm() + excess;
  if (config.mode == RangeMode::Gaussian) return (tag_map - anchor).norm() + excess;
  // The answer flies near the middle of the exchange, poll and final message at its ends; t is the middle.
  const double half = 0.5 * exchangeDuration(config.two_way, (tag_map - anchor).norm());
  const std::array<double, 3> flights{(tagMap(slot.tag, t - half) - anchor).norm() + excess,
                                      (tag_map - anchor).norm() + excess,
                                      (tagMap(slot.tag, t + half) - anchor).norm() + excess};
  return radios.range(slot.tag, slot.anchor, t - half, flights);
}

std::optional<BeaconRange> UwbStream::State::ranged(const Slot& slot, double t, double sigma) {
  const std::size_t link = slot.tag * anchors.size() + slot.anchor;
  const Tag& tag = config.tags[slot.tag];
  const Eigen::Vector3d tag_map = tagMap(slot.tag, t);
  const map::Anchor& anchor = anchors[slot.anchor];
  const double distance = (tag_map - anchor.p_map).norm();
  const RadioChannel::Path path = channel.path(slot.tag, slot.anchor, t, tag_map, anchor.p_map);

  double range = channel.distorted(slot.tag, slot.anchor, undistorted(slot, t, tag_map, path.excess));
  range += anchor.range_bias + noise[link].normal(0.0, config.mode == RangeMode::TagNoise ? 0.0 : sigma);
  BeaconRange reading{.tag = tag.id, .anchor = anchor.id, .range = range, .sigma = config.claimed_sigma};
  if (config.report_tag_body) reading.tag_body = tag.tag_body;
  if (config.power) {
    const RadioPower& law = *config.power;
    const double total = totalPower(law, distance) - (path.hidden ? law.hidden_loss : 0.0);
    const double gap = law.first_path_gap + (path.hidden ? law.hidden_first_path_loss : 0.0);
    reading.rx_power_dbm = power[link].normal(total, law.sigma);
    reading.first_path_power_dbm = power[link].normal(total - gap, law.sigma);
  }
  const bool heard = path.heard && distance <= config.range_max && range > 0.0;
  return heard ? std::optional(reading) : std::nullopt;
}

UwbStream::UwbStream(const UwbConfig& config, const std::vector<map::Anchor>& anchors,
                     std::shared_ptr<const Motion> motion, const RunSetup& run, LineOfSight line_of_sight)
    : state_(std::make_unique<State>(validated(config), anchors, std::move(motion), run,
                                     std::move(line_of_sight))) {
  require(!anchors.empty() || config.mode == RangeMode::TagPosition, config.sensor, "a map with anchors");
}

UwbStream::~UwbStream() = default;

std::optional<Delivery> UwbStream::next() {
  while (state_->ready.empty()) {
    const std::optional<Tick> tick = state_->ticker.next();
    if (!tick) return {};
    state_->cycle(*tick);
  }
  Delivery delivery = std::move(state_->ready.front());
  state_->ready.pop_front();
  return delivery;
}

}  // namespace pos::sim
