#include "pos/ins/standstill.hpp"

#include "pos/core/config_checks.hpp"

namespace pos::ins {

StandstillConfig validated(StandstillConfig config) {
  requirePositive(config.window, "window_s");
  requirePositive(config.force_sigma, "force_sigma_m_per_s2");
  requirePositive(config.rate_sigma, "rate_sigma_deg_per_s");
  requirePositive(config.threshold, "threshold");
  requirePositive(config.gravity, "gravity_m_per_s2");
  return config;
}

void StandstillDetector::add(const ImuIncrement& sample) {
  if (!(sample.dt > 0.0)) return;
  ring_.push_back({sample.velocity / sample.dt, sample.angle / sample.dt, sample.dt});
  time_ += sample.dt;
  // The oldest go while the rest still fills the window.
  while (first_ < ring_.size() && time_ - ring_[first_].dt >= config_.window - 1e-9) {
    time_ -= ring_[first_++].dt;
  }
  if (first_ > 2 * (ring_.size() - first_)) {
    ring_.erase(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
  }
}

std::optional<double> StandstillDetector::statistic() const {
  if (time_ < config_.window - 1e-9) return std::nullopt;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = first_; i < ring_.size(); ++i) mean += ring_[i].f;
  const Eigen::Vector3d gravity = config_.gravity * mean.normalized();
  double sum = 0.0;
  for (std::size_t i = first_; i < ring_.size(); ++i) {
    sum += (ring_[i].f - gravity).squaredNorm() / (config_.force_sigma * config_.force_sigma) +
           ring_[i].w.squaredNorm() / (config_.rate_sigma * config_.rate_sigma);
  }
  return sum / static_cast<double>(ring_.size() - first_);
}

bool StandstillDetector::still() const {
  const auto value = statistic();
  return value && *value < config_.threshold;
}

void StandstillDetector::forget() {
  ring_.clear();
  first_ = 0;
  time_ = 0.0;
}

}  // namespace pos::ins
