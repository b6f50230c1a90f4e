#include <algorithm>
#include <array>

#include "parts.hpp"
#include "pos/core/angle.hpp"
#include "pos/core/error.hpp"
#include "pos/estimation/uwb_imu.hpp"

namespace pos::estimation {
namespace {

constexpr int kFewest = 3;                               // ranges of a plane fix
constexpr double kNoHeading = kPi / 1.7320508075688772;  // rad, sigma of a heading that may be any

}  // namespace

UwbOnlyCore::UwbOnlyCore(const UwbImuConfig& config, std::shared_ptr<const map::TunnelMap> map)
    : config_(config),
      links_(linksOf(config), *map),
      test_(config.robust.form == filters::RobustConfig::Form::None ? uwb::ResidualTest::off()
                                                                    : uwb::ResidualTest()),
      prior_(knownStart(config.start)) {
  ensure(config.start.mode != StartMode::AtTruth,
         "start.mode at_truth must be spelt out before an estimator is made");
}

void UwbOnlyCore::reset(Stamp stamp, const Belief<Pose2>& prior) {
  prior_ = prior;
  fix_ = Fix{stamp, prior.mean.translation(), prior.covariance.topLeftCorner<2, 2>()};
  epoch_.clear();
  counted_ = false;
  last_stamp_ = stamp;
}

IngestReport UwbOnlyCore::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
  const auto* range = std::get_if<BeaconRange>(&measurement.reading);
  if (range == nullptr) return refusal(Verdict::Unsupported, "uwb_only uses ranges and nothing else");
  return take(measurement.stamp, *range);
}

IngestReport UwbOnlyCore::take(Stamp stamp, const BeaconRange& range) {
  const UwbLookUp found = links_.find(range);
  if (found.verdict != Verdict::Applied) return refusal(found.verdict, found.reason);
  if (range.range > config_.range_max)
    return refusal(Verdict::Degenerate, "longer than any radio of this kind reads (range_max_m)");
  last_stamp_ = stamp;
  const bool over = !epoch_.empty() && (stamp - epoch_.first() > durationFromSeconds(config_.epoch_span) ||
                                        epoch_.holds(found.reading));
  if (over) {
    held_ += counted_ ? 0 : 1;
    epoch_.clear();
    counted_ = false;
  }
  epochs_ += epoch_.empty() ? 1 : 0;
  if (!epoch_.add(stamp, found.reading))
    return refusal(Verdict::Degenerate, "more ranges at one moment than can be used");
  if (epoch_.size() >= kFewest) {
    if (const auto fix = solved()) {
      fix_ = fix;
      counted_ = true;
    }
  }
  if (!fix_) return refusal(Verdict::NotInitialised, "gathering ranges for the first fix");
  return {.verdict = Verdict::Applied};
}

/// Of two mirror images the one next to the fix before, or to the start.
std::optional<UwbOnlyCore::Fix> UwbOnlyCore::solved() const {
  std::array<uwb::TagRange, uwb::kMaxRanges> ranges;
  std::size_t count = 0;
  for (const uwb::BodyRange& range : epoch_.ranges()) ranges[count++] = uwb::tagRange(range, config_.height);
  const uwb::TagFixes fixes = uwb::multilaterated({ranges.data(), count}, test_);
  if (fixes.count == 0) return std::nullopt;
  // Where the heading is not known, the lever arm of the tag is a part of the error.
  const Eigen::Vector2d lever = epoch_.ranges().front().tag_body.head<2>();
  const Eigen::Vector2d arm = rotation2(prior_.mean.yaw) * lever;
  const Eigen::Vector2d last = (fix_ ? fix_->p_map : prior_.mean.translation()) + arm;
  const auto all = fixes.all();
  const auto best = std::min_element(all.begin(), all.end(), [&](const auto& a, const auto& b) {
    return (a.p_map - last).squaredNorm() < (b.p_map - last).squaredNorm();
  });
  const Matrix<2, 2> any_side = lever.squaredNorm() * Matrix<2, 2>::Identity();
  return Fix{epoch_.middle(), best->p_map - arm, best->covariance + any_side};
}

std::optional<Estimate> UwbOnlyCore::estimateAt(Stamp stamp) const {
  if (!fix_ || stamp < fix_->stamp || (last_stamp_ && stamp < *last_stamp_)) return std::nullopt;
  Matrix<3, 3> covariance = Matrix<3, 3>::Zero();
  const double moved = config_.max_speed * seconds(stamp - fix_->stamp);
  covariance.topLeftCorner<2, 2>() = fix_->covariance + square(moved) * Matrix<2, 2>::Identity();
  covariance(2, 2) = square(kNoHeading);
  const Pose2 pose{fix_->p_map.x(), fix_->p_map.y(), prior_.mean.yaw};
  return planarEstimate(stamp, pose, covariance, config_.height);
}

Diagnostics UwbOnlyCore::diagnostics() const {
  return {{"epochs", static_cast<double>(epochs_)}, {"epochs_without_fix", static_cast<double>(held_)}};
}

}  // namespace pos::estimation
