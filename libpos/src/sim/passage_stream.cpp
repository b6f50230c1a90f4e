#include "pos/sim/passage_stream.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "pos/core/config_checks.hpp"

namespace pos::sim {
namespace {

constexpr double kStanding = 0.01;  // m/s
constexpr std::uint32_t kChoices = Ticker::kFirstPurpose;
constexpr std::uint32_t kNoise = Ticker::kFirstPurpose + 1;

/// Direction of travel; where the body stands, the way it faces.
Eigen::Vector3d wayOf(const Kinematics& body) {
  const double speed = body.v_map.norm();
  return speed > kStanding ? Eigen::Vector3d(body.v_map / speed) : Eigen::Vector3d(body.R_map_body.col(0));
}

}  // namespace

PassageConfig validated(PassageConfig config) {
  const std::string& key = config.sensor;
  requireValid(config.timing, key + ".timing");
  require(config.antenna_body.allFinite(), key + ".antenna_body", "three numbers, m");
  require(!config.places.empty(), key + ".places", "at least one place");
  std::set<std::string> names;
  for (const PassagePlace& place : config.places) {
    require(names.insert(place.name).second, key + ".places[" + place.name + "]", "every name once");
    require(place.p_map.allFinite(), key + ".places[" + place.name + "].p_map", "three numbers, m");
  }
  requirePositive(config.radius, key + ".radius", "m");
  requirePositive(config.rise, key + ".rise", "m");
  requireNotNegative(config.sigma, key + ".sigma", "m");
  requireNotNegative(config.sigma_time, key + ".sigma_time", "s");
  requireNotNegative(config.sigma_across, key + ".sigma_across", "m");
  requireShare(config.missed_probability, key + ".missed_probability");
  requireShare(config.wrong_probability, key + ".wrong_probability");
  require(config.wrong_probability == 0.0 || config.places.size() > 1, key + ".wrong_probability",
          "0 with a single place: there is no other to mistake it for");
  return config;
}

PassageStream::PassageStream(const PassageConfig& config, std::shared_ptr<const Motion> motion,
                             const RunSetup& run)
    : config_(validated(config)),
      motion_(std::move(motion)),
      ticker_(config_.timing, run, motion_->duration()),
      choices_(randomStream(run, config_.timing, kChoices)),
      noise_(randomStream(run, config_.timing, kNoise)),
      visits_(config_.places.size()) {}

double PassageStream::distance(std::size_t place, const Kinematics& body) const {
  return (body.p_map + body.R_map_body * config_.antenna_body - config_.places[place].p_map).norm();
}

PassageStream::Visit PassageStream::begun(std::size_t place, double t, double d) {
  Visit visit{.open = true, .begin = t, .nearest_t = t, .nearest = d};
  visit.read_at = choices_.uniform(0.0, config_.radius);
  visit.read_leaving = choices_.bernoulli(0.5);
  visit.missed = choices_.bernoulli(config_.missed_probability);
  const bool wrong = choices_.bernoulli(config_.wrong_probability);
  const double other = choices_.uniform();
  const auto others = static_cast<double>(config_.places.size() - 1);
  const auto shift = 1 + static_cast<std::size_t>(std::min(other * others, std::max(others - 1.0, 0.0)));
  visit.told = wrong ? (place + shift) % config_.places.size() : place;
  return visit;
}

/// Golden-section search about the nearest look.
double PassageStream::closestApproach(std::size_t place, const Visit& visit) const {
  constexpr double kGolden = 0.6180339887498949;
  double low = std::max(visit.nearest_t - 1.0 / config_.timing.rate, 0.0);
  double high = std::min(visit.nearest_t + 1.0 / config_.timing.rate, motion_->duration());
  for (int i = 0; i < 60; ++i) {
    const double width = high - low;
    if (distance(place, motion_->at(high - kGolden * width)) <
        distance(place, motion_->at(low + kGolden * width))) {
      high = low + kGolden * width;
    } else {
      low = high - kGolden * width;
    }
  }
  return 0.5 * (low + high);
}

std::optional<double> PassageStream::detected(std::size_t place, const Visit& visit, double t,
                                              double d) const {
  if (config_.style == PassageStyle::ClosestApproach) {
    const bool came_nearer = visit.nearest_t > visit.begin;  // else the run began inside and only leaves
    const bool recognised = d >= visit.nearest + config_.rise || d > config_.radius;
    return came_nearer && recognised ? std::optional(closestApproach(place, visit)) : std::nullopt;
  }
  const bool stands = d <= config_.radius && motion_->at(t).v_map.norm() < kStanding;
  const bool rising = t > visit.nearest_t;
  const bool reached = visit.read_leaving ? rising && d >= visit.read_at : d <= visit.read_at || rising;
  return stands || reached ? std::optional(t) : std::nullopt;
}

PassageFix PassageStream::fix(const PassagePlace& told, double t) {
  const bool approach = config_.style == PassageStyle::ClosestApproach;
  const Kinematics body = motion_->at(t);
  const Eigen::Vector3d way = wayOf(body);
  const double timing = body.v_map.norm() * config_.sigma_time;
  const double along =
      approach ? config_.sigma * config_.sigma + timing * timing : config_.radius * config_.radius / 3.0;
  const double across = config_.sigma_across * config_.sigma_across;
  PassageFix fix{.place = told.name, .p_map = told.p_map, .p_body = config_.antenna_body};
  if (approach) fix.p_map += noise_.normal(0.0, config_.sigma) * way;
  fix.covariance = across * Eigen::Matrix3d::Identity() + (along - across) * way * way.transpose();
  return fix;
}

void PassageStream::look(std::size_t place, const Tick& tick, const Kinematics& body) {
  Visit& visit = visits_[place];
  const double d = distance(place, body);
  if (!visit.open && d <= config_.radius) visit = begun(place, tick.t, d);
  if (!visit.open) return;
  if (d < visit.nearest) {
    visit.nearest = d;
    visit.nearest_t = tick.t;
  }
  if (!visit.done) {
    if (const std::optional<double> moment = detected(place, visit, tick.t, d)) {
      visit.done = true;
      const PassageFix found = fix(config_.places[visit.told], *moment);
      const bool approach = config_.style == PassageStyle::ClosestApproach;
      const double slip = approach ? noise_.normal(0.0, config_.sigma_time) : 0.0;
      const double stamp = std::clamp(*moment + slip, 0.0, tick.t);
      if (!visit.missed && !tick.lost) ready_.push_back(ticker_.sent(stamp, tick.t, config_.sensor, found));
    }
  }
  if (d > config_.radius) visit.open = false;
}

std::optional<Delivery> PassageStream::next() {
  while (ready_.empty()) {
    const std::optional<Tick> tick = ticker_.next();
    if (!tick) return {};
    const Kinematics body = motion_->at(tick->t);
    for (std::size_t place = 0; place < config_.places.size(); ++place) look(place, *tick, body);
  }
  Delivery delivery = std::move(ready_.front());
  ready_.pop_front();
  return delivery;
}

}  // namespace pos::sim
