#include "pos/estimation/shearer.hpp"

#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "shearer_parts.hpp"

namespace pos::estimation {
namespace {

std::vector<int> modesOf(const ShearerConfig& config) {
  if (config.selection.mode == 0) return {2, 7};
  return {config.selection.mode};
}

}  // namespace

Shearer::Shearer(const ShearerConfig& config, const std::shared_ptr<const map::TunnelMap>& map)
    : config_(config),
      earth_(shearerEarth(config, *map)),
      finder_(legFinderOf(config.legs)),
      wheels_(ins::OdometerConfig{}),
      creep_(config.face, config.legs.calibration) {}

void Shearer::reset(Stamp stamp, const Belief<Pose2>& prior) {
  given_ = prior;
  running_ = false;
  last_stamp_ = stamp;
  imu_.forget();
  filters_.clear();
  kept_.clear();
  kept_.shrink_to_fit();
  wheels_.forget();
  creep_.forget();
  eta_ = 0.0;
  was_degraded_ = false;
}

void Shearer::start() {
  const ins::NavigationState nav = shearerStart(config_, given_);
  const Eigen::Matrix<double, 15, 15> P = shearerStartCovariance(config_, given_);
  filters_.clear();
  for (const int mode : modesOf(config_)) {
    filters_.emplace_back(config_, mode);
    filters_.back().start(earth_, nav, P);
  }
  keeping_ = config_.picm.use == PicmConfig::Use::Restart;
  running_ = true;
}

IngestReport Shearer::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
  const IngestReport report =
      std::visit([&](const auto& reading) { return take(measurement, reading); }, measurement.reading);
  if (movesTimeOn(report)) last_stamp_ = measurement.stamp;
  return report;
}

IngestReport Shearer::take(const Measurement& measurement, const ImuSample& sample) {
  const ImuIntake::Told told = imu_.take(measurement.stamp, sample);
  if (!told.refusal.empty()) return refusal(Verdict::Degenerate, told.refusal);
  if (!running_) start();
  IngestReport report{.verdict = Verdict::Applied};
  if (told.raw.dt == 0.0) return report;
  if (keeping_) kept_.emplace_back(told.raw);
  bool arrived_at_2 = false;
  for (ShearerFilter& filter : filters_) {
    const FaceProgress::Event event = filter.step(told.raw);
    if (&filter != &filters_.front()) continue;
    if (event == FaceProgress::Event::Arrived) report.event = "at the end of a pass";
    if (event == FaceProgress::Event::Returned) report.event = "the next pass begins";
    arrived_at_2 = event == FaceProgress::Event::Arrived && filter.progress().arrivals() == 1 &&
                   filter.progress().end() == 2;
  }
  if (arrived_at_2) {
    chooseMode();
    alignMount();
    if (config_.picm.use != PicmConfig::Use::Off) report.event = "at end 2: the scanner's mount is corrected";
  }
  const bool degraded = best().degraded();
  if (degraded != was_degraded_) {
    report.event = degraded ? "no legs for too long: position degraded" : "legs are back";
    was_degraded_ = degraded;
  }
  return report;
}

/// Modes 2 and 7 side by side: the one that comes nearer to the rack's length stays (section 5.2, step 3).
void Shearer::chooseMode() {
  if (filters_.size() < 2) return;
  const auto misses = [&](const ShearerFilter& filter) {
    return std::abs(filter.station() - config_.face.length);
  };
  if (misses(filters_[1]) < misses(filters_[0])) std::swap(filters_[0], filters_[1]);
  filters_.erase(filters_.begin() + 1, filters_.end());
}

void Shearer::alignMount() {
  using Use = PicmConfig::Use;
  if (config_.picm.use == Use::Off) return;
  eta_ = best().picmAngle();
  if (config_.picm.use == Use::Continue) {
    filters_.front().turnMount(eta_);
    return;
  }
  ShearerFilter again(config_, best().mode());
  again.start(earth_, shearerStart(config_, given_), shearerStartCovariance(config_, given_));
  again.turnMount(eta_);
  for (const Kept& kept : kept_) {
    if (const auto* raw = std::get_if<ins::ImuIncrement>(&kept)) (void)again.step(*raw);
    if (const auto* leg = std::get_if<KeptLeg>(&kept))
      (void)again.see(leg->measured, leg->covariance, leg->age);
  }
  filters_.front() = std::move(again);
  keeping_ = false;
  kept_.clear();
  kept_.shrink_to_fit();
}

}  // namespace pos::estimation
