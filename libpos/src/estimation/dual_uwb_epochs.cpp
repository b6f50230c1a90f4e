#include "pos/estimation/dual_uwb_epochs.hpp"

#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/core/error.hpp"
#include "pos/estimation/dual_uwb_bank.hpp"

namespace pos::estimation {
namespace {

constexpr double kTurnedRound = 0.75 * kPi;  // rad, no vehicle turns as far between two epochs

bool cheaper(const EpochPose& a, const EpochPose& b) {
  return a.cost < b.cost;
}

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
  current_ = EpochFix{{}, {{.pose = knownStart(config.start)}}};  // its stamp is that of the first range
}

void DualUwbEpochs::reset(Stamp stamp, const Belief<Pose2>& prior) {
  current_ = previous_ = EpochFix{stamp, {{.pose = prior}}};
  twist_.reset();
  solved_ = false;
  epoch_.clear();
  expected_ = uwb::kMaxRanges + 1;
  mapper_previous_.reset();
  mapper_current_.reset();
  last_stamp_ = stamp;
}

IngestReport DualUwbEpochs::ingest(const Measurement& measurement) {
  if (const auto refused = refusedUnseen(measurement, last_stamp_)) return *refused;
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
  if (previous_ && fix->certain() && previous_->certain() &&
      std::abs(wrapAngle(fix->best().mean.yaw - previous_->best().mean.yaw)) > kTurnedRound &&
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
  EpochFix result{epoch_.middle(), {}};
  for (const uwb::RigidFix& fix : fixes.all())
    result.poses.push_back({.pose = fix.pose, .cost = fix.chi_square});
  return result;
}

/// The first two tags; left and right as the configuration or the log lists them.
uwb::TagPair DualUwbEpochs::pair() const {
  return {links_.tag(0).p_body.head<2>(), links_.tag(1).p_body.head<2>()};
}

/// Every place of one tag that its ranges of the epoch fit.
uwb::TagFixes DualUwbEpochs::tagFixes(const TagMount& tag) const {
  std::array<uwb::TagRange, uwb::kMaxRanges> ranges;
  std::size_t count = 0;
  for (const uwb::BodyRange& range : epoch_.ranges()) {
    if (range.tag != tag.id) continue;
    ranges[count++] = uwb::tagRange(range, config_.body_height);
  }
  const uwb::TagFixes fixes = uwb::multilaterated({ranges.data(), count}, test_);
  return uwb::keptInside(fixes, [&](const uwb::TagFix& fix) { return roadway_.inside(fix.p_map); });
}

/// Both tags by themselves; of their mirror images those that fit the baseline.
std::optional<EpochFix> DualUwbEpochs::snapshotFix() const {
  if (links_.tags() < 2) return std::nullopt;
  const uwb::TagFixes lefts = tagFixes(links_.tag(0));
  const uwb::TagFixes rights = tagFixes(links_.tag(1));
  EpochFix result{epoch_.middle(), {}};
  for (const uwb::TagFix& left : lefts.all()) {
    for (const uwb::TagFix& right : rights.all()) {
      const auto snapshot =
          uwb::snapshotPose({left.p_map, left.covariance}, {right.p_map, right.covariance}, pair());
      if (!snapshot) continue;
      const double cost = left.chi_square + right.chi_square + snapshot->baseline_chi_square;
      result.poses.push_back({snapshot->pose, cost, left.p_map, right.p_map});
    }
  }
  if (result.poses.empty()) return std::nullopt;
  std::stable_sort(result.poses.begin(), result.poses.end(), cheaper);
  const double most = result.poses.front().cost + uwb::kRuledOut;
  std::erase_if(result.poses, [&](const EpochPose& p) { return p.cost > most; });
  return result;
}

/// Of several poses those that the last epoch's pose can have become; all of them where that one was not sure
/// itself, then the one next to it first, so that the answer does not jump from image to image.
EpochFix DualUwbEpochs::resolved(EpochFix fix) const {
  if (fix.certain() || !previous_) return fix;
  const Matrix<3, 3> moved = unknownMotion(config_, seconds(fix.stamp - previous_->stamp));
  const Belief<Pose2>& before = previous_->best();
  const auto distance = [&](const EpochPose& p) {
    const Matrix<3, 3> S = p.pose.covariance + before.covariance + moved;
    const Vector<3> apart = minus(p.pose.mean, before.mean);
    return p.cost + apart.dot(S.llt().solve(apart));
  };
  if (!previous_->certain()) {
    std::iter_swap(fix.poses.begin(), std::min_element(fix.poses.begin(), fix.poses.end(),
                                                       [&](const EpochPose& a, const EpochPose& b) {
                                                         return distance(a) < distance(b);
                                                       }));
    return fix;
  }
  for (EpochPose& p : fix.poses) p.cost = distance(p);
  const double least = std::min_element(fix.poses.begin(), fix.poses.end(), cheaper)->cost;
  std::erase_if(fix.poses, [&](const EpochPose& p) { return p.cost > least + uwb::kRuledOut; });
  for (EpochPose& p : fix.poses) p.cost -= least;
  return fix;
}

/// The paper's mapping: the pose is the one before plus what both tags advanced.
void DualUwbEpochs::differentiate(EpochFix& fix) {
  EpochPose& best = fix.poses.front();
  if (mapper_previous_) {
    mapper_current_ = mapper_previous_;
    mapper_current_->advance(best.left_map, best.right_map);
  } else {
    // a start that was given holds; its error stays, since nothing but increments is used from then on
    const Pose2 start = previous_ ? previous_->best().mean : best.pose.mean;
    mapper_current_.emplace(start, pair(), best.left_map, best.right_map);
  }
  best.pose.mean = mapper_current_->pose();
}

/// Equation 5 of the paper, in body axes at the later pose: differences over the time between.
std::optional<PlanarTwist> DualUwbEpochs::twistBetween(const EpochFix& before, const EpochFix& now) const {
  const double dt = seconds(now.stamp - before.stamp);
  if (!(dt > 0.0) || !before.certain() || !now.certain()) return std::nullopt;
  const Vector<3> change = minus(now.best().mean, before.best().mean) / dt;
  Matrix<3, 3> R_body_map = Matrix<3, 3>::Identity();
  R_body_map.topLeftCorner<2, 2>() = rotation2(before.best().mean.yaw + 0.5 * dt * change[2]).transpose();
  PlanarTwist twist;
  twist.rates = R_body_map * change;
  twist.covariance =
      R_body_map * (now.best().covariance + before.best().covariance) * R_body_map.transpose() / (dt * dt);
  return twist;
}

std::optional<Estimate> DualUwbEpochs::estimateAt(Stamp stamp) const {
  if (!last_stamp_ || !current_ || stamp < current_->stamp) return std::nullopt;
  const Belief<Pose2>& pose = current_->best();
  Matrix<3, 3> covariance = pose.covariance;
  if (!current_->certain()) {  // one of several: its pose with the spread of all of them about it
    const auto weight = [&](const EpochPose& p) {
      return std::exp(-0.5 * (p.cost - current_->poses.front().cost));
    };
    double total = 0.0;
    for (const EpochPose& p : current_->poses) total += weight(p);
    covariance.setZero();
    for (const EpochPose& p : current_->poses)
      covariance += spreadAbout(pose.mean, p.pose, weight(p) / total);
  }
  covariance += unknownMotion(config_, seconds(stamp - current_->stamp));
  Estimate estimate = planarEstimate(stamp, pose.mean, covariance, config_.body_height);
  estimate.twist = twist_;
  return estimate;
}

Diagnostics DualUwbEpochs::diagnostics() const {
  Diagnostics values{{"hypotheses", current_ ? static_cast<double>(current_->poses.size()) : 0.0},
                     {"epochs", static_cast<double>(epochs_)},
                     {"epochs_unsolved", static_cast<double>(unsolved_)},
                     {"heading_turned_round", static_cast<double>(turned_round_)}};
  if (!current_) return values;
  for (std::size_t k = 1; k < current_->poses.size(); ++k) {
    for (const auto& value : alternative(static_cast<int>(k), current_->poses[k].pose))
      values.push_back(value);
  }
  return values;
}

}  // namespace pos::estimation
