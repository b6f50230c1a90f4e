#include "pos/estimation/dual_uwb_epochs.hpp"

#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/core/error.hpp"
#include "pos/estimation/dual_uwb_bank.hpp"

namespace pos::estimation {
namespace {

constexpr double kAmbiguous = 13.8;          // difference of chi^2 from which a pose is ruled out (1 in 1000)
constexpr double kTurnedRound = 0.75 * kPi;  // rad, no vehicle turns as far between two epochs

/// What a pose may have become in dt seconds of unknown motion.
Matrix<3, 3> unknownMotion(const DualUwbConfig& config, double dt) {
  return Vector<3>(square(config.max_speed * dt), square(config.max_speed * dt),
                   square(config.max_yaw_rate * dt))
      .asDiagonal();
}

}  // namespace

DualUwbEpochs::DualUwbEpochs(const DualUwbConfig& config, std::shared_ptr<const map::TunnelMap> map)
    : config_(config), roadway_(config, map), links_(config, *map), test_(config.fit_significance) {
  if (config.start.mode != StartMode::Known) return;
  EpochFix start;
  start.poses[0].mean = config.start.pose;
  start.poses[0].covariance.diagonal() << square(config.start.position_sigma),
      square(config.start.position_sigma), square(config.start.yaw_sigma);
  start.count = 1;
  current_ = start;  // its stamp is that of the first range
}

void DualUwbEpochs::reset(Stamp stamp, const Belief<Pose2>& prior) {
  EpochFix start;
  start.stamp = stamp;
  start.poses[0] = prior;
  start.count = 1;
  current_ = previous_ = start;
  twist_.reset();
  solved_ = false;
  epoch_.clear();
  expected_ = uwb::kMaxRanges + 1;
  mapper_previous_.reset();
  mapper_current_.reset();
  last_stamp_ = stamp;
}

IngestReport DualUwbEpochs::ingest(const Measurement& measurement) {
  if (defect(measurement)) return refusal(Verdict::Degenerate, "the reading itself is not valid");
  if (last_stamp_ && measurement.stamp < *last_stamp_)
    return refusal(Verdict::TooOld, "older than the state");
  return std::visit([&](const auto& reading) { return take(measurement.stamp, reading); },
                    measurement.reading);
}

bool DualUwbEpochs::belongs(Stamp stamp, const UwbReading& reading) const {
  return epoch_.empty() ||
         (stamp - epoch_.first() <= durationFromSeconds(config_.epoch_span) && !epoch_.holds(reading));
}

IngestReport DualUwbEpochs::take(Stamp stamp, const BeaconRange& range) {
  const UwbLookUp looked_up = links_.find(range);
  if (looked_up.verdict != Verdict::Applied) return refusal(looked_up.verdict, looked_up.reason);
  if (!last_stamp_ && current_) {  // a start from the configuration begins with the first range
    current_->stamp = stamp;
    previous_ = current_;
  }
  last_stamp_ = stamp;
  IngestReport report{.verdict = Verdict::Applied};
  if (!belongs(stamp, looked_up.reading)) finishEpoch();
  if (!epoch_.add(stamp, looked_up.reading)) {
    return refusal(Verdict::Degenerate, "more ranges at one moment than can be used");
  }
  if (epoch_.size() >= expected_) report.event = solve();
  if (!current_) return refusal(Verdict::NotInitialised, "gathering ranges for the first pose");
  return report;
}

/// The epoch is over: what it says is final, and the next one is compared with it.
void DualUwbEpochs::finishEpoch() {
  if (!solved_) (void)solve();
  ++epochs_;
  unsolved_ += solved_ ? 0 : 1;
  expected_ = epoch_.size();
  if (solved_) {
    previous_ = current_;
    mapper_previous_ = mapper_current_;
  }
  epoch_.clear();
  solved_ = false;
}

std::string_view DualUwbEpochs::solve() {
  auto fix = config_.variant == DualUwbConfig::Variant::Rigid ? rigidFix() : snapshotFix();
  if (!fix) return {};
  *fix = resolved(*fix);
  std::string_view event;
  if (previous_ && fix->count == 1 && previous_->count == 1 &&
      std::abs(wrapAngle(fix->poses[0].mean.yaw - previous_->poses[0].mean.yaw)) > kTurnedRound &&
      fix->stamp - previous_->stamp < durationFromSeconds(1.0)) {
    ++turned_round_;
    event = "heading turned round from one epoch to the next: are the tags swapped?";
  }
  if (config_.variant == DualUwbConfig::Variant::Differential) differentiate(*fix);
  twist_ = previous_ ? twistBetween(*previous_, *fix) : std::nullopt;
  current_ = fix;
  solved_ = true;
  return event;
}

std::optional<EpochFix> DualUwbEpochs::rigidFix() const {
  uwb::RigidFixes fixes = uwb::rigidFixes(epoch_.ranges(), config_.body_height, test_);
  if (fixes.count == 0) return std::nullopt;
  fixes = uwb::keptInside(
      fixes, [&](const uwb::RigidFix& fix) { return roadway_.inside(fix.pose.mean.translation()); });
  EpochFix result{.stamp = epoch_.middle()};
  for (const uwb::RigidFix& fix : fixes.all()) {
    const auto k = static_cast<std::size_t>(result.count++);
    result.poses[k] = fix.pose;
    result.costs[k] = fix.chi_square;
  }
  return result;
}

/// Both tags by themselves; of their mirror images those that fit the baseline.
std::optional<EpochFix> DualUwbEpochs::snapshotFix() const {
  if (links_.tags() < 2) return std::nullopt;
  std::array<std::array<uwb::TagRange, uwb::kMaxRanges>, 2> ranges;
  std::array<std::size_t, 2> counts{};
  for (const uwb::BodyRange& range : epoch_.ranges()) {
    for (std::size_t t = 0; t < 2; ++t) {
      const TagMount& tag = links_.tag(static_cast<int>(t));
      if (range.tag != tag.id) continue;
      ranges[t][counts[t]++] = {range.anchor_map.head<2>(),
                                range.anchor_map.z() - config_.body_height - tag.p_body.z(), range.range,
                                range.sigma};
    }
  }
  std::array<uwb::TagFixes, 2> fixes;
  for (std::size_t t = 0; t < 2; ++t) {
    fixes[t] = uwb::multilaterated({ranges[t].data(), counts[t]}, test_);
    fixes[t] = uwb::keptInside(fixes[t], [&](const uwb::TagFix& fix) { return roadway_.inside(fix.p_map); });
  }
  const uwb::TagPair pair{links_.tag(0).p_body.head<2>(), links_.tag(1).p_body.head<2>()};
  EpochFix result{.stamp = epoch_.middle()};
  for (const uwb::TagFix& left : fixes[0].all()) {
    for (const uwb::TagFix& right : fixes[1].all()) {
      const uwb::TagPosition at_left{left.p_map, left.covariance};
      const uwb::TagPosition at_right{right.p_map, right.covariance};
      const auto snapshot = uwb::snapshotPose(at_left, at_right, pair);
      if (!snapshot) continue;
      const double cost = left.chi_square + right.chi_square + snapshot->baseline_chi_square;
      auto k = static_cast<std::size_t>(result.count++);
      for (; k > 0 && cost < result.costs[k - 1]; --k) {
        result.poses[k] = result.poses[k - 1];
        result.costs[k] = result.costs[k - 1];
        result.left[k] = result.left[k - 1];
        result.right[k] = result.right[k - 1];
      }
      result.poses[k] = snapshot->pose;
      result.costs[k] = cost;
      result.left[k] = at_left;
      result.right[k] = at_right;
    }
  }
  if (result.count == 0) return std::nullopt;
  while (result.count > 1 &&
         result.costs[static_cast<std::size_t>(result.count) - 1] > result.costs[0] + kAmbiguous) {
    --result.count;
  }
  return result;
}

/// Of several poses those that the last epoch's pose can have become; all of them where that one was not sure
/// itself, then the one next to it first, so that the answer does not jump from image to image.
EpochFix DualUwbEpochs::resolved(EpochFix fix) const {
  if (fix.count < 2 || !previous_) return fix;
  const double dt = seconds(fix.stamp - previous_->stamp);
  std::array<double, 4> distance{};
  for (std::size_t k = 0; k < static_cast<std::size_t>(fix.count); ++k) {
    const Matrix<3, 3> S =
        fix.poses[k].covariance + previous_->poses[0].covariance + unknownMotion(config_, dt);
    const Vector<3> apart = minus(fix.poses[k].mean, previous_->poses[0].mean);
    distance[k] = fix.costs[k] + apart.dot(S.llt().solve(apart));
  }
  const auto nearest = std::min_element(distance.begin(), distance.begin() + fix.count);
  if (previous_->count > 1) {
    const auto k = static_cast<std::size_t>(nearest - distance.begin());
    std::swap(fix.poses[0], fix.poses[k]);
    std::swap(fix.costs[0], fix.costs[k]);
    std::swap(fix.left[0], fix.left[k]);
    std::swap(fix.right[0], fix.right[k]);
    return fix;
  }
  const double least = *nearest;
  EpochFix kept = fix;
  kept.count = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(fix.count); ++k) {
    if (distance[k] > least + kAmbiguous) continue;
    const auto place = static_cast<std::size_t>(kept.count++);
    kept.poses[place] = fix.poses[k];
    kept.costs[place] = distance[k] - least;
    kept.left[place] = fix.left[k];
    kept.right[place] = fix.right[k];
  }
  return kept;
}

/// The paper's mapping: the pose is the one before plus what both tags advanced.
void DualUwbEpochs::differentiate(EpochFix& fix) {
  const uwb::TagPair pair{links_.tag(0).p_body.head<2>(), links_.tag(1).p_body.head<2>()};
  if (mapper_previous_) {
    mapper_current_ = mapper_previous_;
    mapper_current_->advance(fix.left[0].p_map, fix.right[0].p_map);
  } else {
    // a start that was given holds; its error stays, since nothing but increments is used from then on
    const Pose2 start = previous_ ? previous_->poses[0].mean : fix.poses[0].mean;
    mapper_current_.emplace(start, pair, fix.left[0].p_map, fix.right[0].p_map);
  }
  fix.poses[0].mean = mapper_current_->pose();
}

/// Equation 5 of the paper, in body axes at the later pose: differences over the time between.
std::optional<PlanarTwist> DualUwbEpochs::twistBetween(const EpochFix& before, const EpochFix& now) const {
  const double dt = seconds(now.stamp - before.stamp);
  if (!(dt > 0.0) || before.count != 1 || now.count != 1) return std::nullopt;
  const Vector<3> change = minus(now.poses[0].mean, before.poses[0].mean) / dt;
  Matrix<3, 3> R_body_map = Matrix<3, 3>::Identity();
  R_body_map.topLeftCorner<2, 2>() = rotation2(before.poses[0].mean.yaw + 0.5 * dt * change[2]).transpose();
  PlanarTwist twist;
  twist.rates = R_body_map * change;
  twist.covariance = R_body_map * (now.poses[0].covariance + before.poses[0].covariance) *
                     R_body_map.transpose() / (dt * dt);
  return twist;
}

std::optional<Estimate> DualUwbEpochs::estimateAt(Stamp stamp) const {
  if (!last_stamp_ || !current_ || stamp < current_->stamp) return std::nullopt;
  const Belief<Pose2>& pose = current_->poses[0];
  Matrix<3, 3> covariance = pose.covariance;
  if (current_->count > 1) {  // one of several: its pose with the spread of all of them about it
    const auto weight = [&](std::size_t k) {
      return std::exp(-0.5 * (current_->costs[k] - current_->costs[0]));
    };
    const auto count = static_cast<std::size_t>(current_->count);
    double total = 0.0;
    for (std::size_t k = 0; k < count; ++k) total += weight(k);
    covariance.setZero();
    for (std::size_t k = 0; k < count; ++k)
      covariance += spreadAbout(pose.mean, current_->poses[k], weight(k) / total);
  }
  covariance += unknownMotion(config_, seconds(stamp - current_->stamp));
  Estimate estimate = planarEstimate(stamp, pose.mean, covariance, config_.body_height);
  estimate.twist = twist_;
  return estimate;
}

Diagnostics DualUwbEpochs::diagnostics() const {
  Diagnostics values{{"hypotheses", current_ ? static_cast<double>(current_->count) : 0.0},
                     {"epochs", static_cast<double>(epochs_)},
                     {"epochs_unsolved", static_cast<double>(unsolved_)},
                     {"heading_turned_round", static_cast<double>(turned_round_)}};
  for (int k = 1; current_ && k < current_->count; ++k) {  // mirror images are told, not averaged
    const std::string name = "alternative_" + std::to_string(k) + "_";
    const Belief<Pose2>& other = current_->poses[static_cast<std::size_t>(k)];
    values.push_back({name + "x_m", other.mean.x, std::sqrt(other.covariance(0, 0))});
    values.push_back({name + "y_m", other.mean.y, std::sqrt(other.covariance(1, 1))});
  }
  return values;
}

}  // namespace pos::estimation
