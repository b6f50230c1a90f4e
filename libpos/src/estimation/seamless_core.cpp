#include "pos/estimation/seamless_core.hpp"

#include <algorithm>
#include <cmath>

#include "parts.hpp"
#include "pos/core/chi_square.hpp"
#include "seamless_parts.hpp"

namespace pos::estimation {
namespace {

using filters::Evidence;
using filters::LikelihoodForm;
using filters::Modes;

constexpr std::array<std::string_view, kSeamlessModes> kNames{"gnss", "uwb"};
constexpr double kRecovery = 10.0;  // on the covariance, each time the state is doubted
constexpr double kClipped = 12.0;   // squared sigmas of a range, for learning

std::size_t other(std::size_t mode) {
  return 1 - mode;
}
Eigen::Index row(std::size_t mode) {
  return static_cast<Eigen::Index>(mode);
}

}  // namespace

SeamlessCore::SeamlessCore(const SeamlessConfig& config)
    : config_(std::make_shared<const SeamlessConfig>(config)),
      fuzzy_(std::make_shared<const filters::FuzzyController>(config.fuzzy)),
      gnss_gate_(chiSquareQuantile(config.gnss.confidence, 3.0)),
      watch_{ModeWatch({config.imm.overdue, config.imm.rejected_in_a_row}),
             ModeWatch({config.imm.overdue, config.imm.rejected_in_a_row})} {}

void SeamlessCore::start(Stamp stamp, const Belief<EskfState>& belief) {
  beliefs_ = {belief, belief};
  stamp_ = weighed_ = mixed_ = believed_ = stamp;
  mu_ = {config_->imm.first_gnss, 1.0 - config_->imm.first_gnss};
  sigma_.fill(kUnsure);
}

bool SeamlessCore::anyUsable() const {
  return watch_[kGnss].usable() || watch_[kUwb].usable();
}

/// Without any usable mode the likelier one carries on alone.
bool SeamlessCore::inUse(std::size_t mode) const {
  return anyUsable() ? watch_[mode].usable() : mu_[row(mode)] >= mu_[row(other(mode))];
}

Belief<EskfState> SeamlessCore::combined() const {
  if (!inUse(kGnss)) return beliefs_[kUwb];
  if (!inUse(kUwb)) return beliefs_[kGnss];
  return filters::combined<EskfState, 2>(beliefs_, mu_);
}

std::vector<ModeState> SeamlessCore::modeStates() const {
  std::vector<ModeState> states;
  for (std::size_t j = 0; j < kSeamlessModes; ++j) {
    states.push_back({.name = kNames[j],
                      .probability = mu_[row(j)],
                      .usable = watch_[j].usable(),
                      .since = watch_[j].since(),
                      .last_applied = watch_[j].lastApplied(),
                      .sigma = sigma_[j]});
  }
  return states;
}

// ---------------------------------------------------------------- time

std::string_view SeamlessCore::propagate(const ins::ImuIncrement& raw, Stamp stamp) {
  std::string_view event = close();
  const ins::EskfProcess process = processOf(config_->imu, config_->standstill.gravity);
  if (inUse(kGnss)) ins::propagate(beliefs_[kGnss], raw, process);
  if (inUse(kUwb)) offsets_.propagate(beliefs_[kUwb], raw, process);
  stamp_ = stamp;
  for (std::size_t j = 0; j < kSeamlessModes; ++j) {
    if (!watch_[j].advanced(stamp)) continue;
    event = j == kGnss ? "satellites fell silent" : "the radio fell silent";
    // The one that falls silent last carries on, and is the answer.
    if (!anyUsable()) mu_ = Vector<2>::Unit(row(j));
    forceFloor();
  }
  if (!anyUsable() && seconds(stamp - believed_) > config_->imm.recover_after) {
    for (auto& belief : beliefs_) belief.covariance *= kRecovery;
    believed_ = stamp;
    event = "nothing heard is believed: the state is made uncertain";
  }
  return event;
}

/// pi over any time, from its value over the nominal one: a two-state Markov process.
Matrix<2, 2> SeamlessCore::transition(double dt) const {
  const double memory = std::pow(2.0 * config_->imm.stay - 1.0, dt / config_->imm.period);
  const double stay = 0.5 * (1.0 + memory);
  return Matrix<2, 2>{{stay, 1.0 - stay}, {1.0 - stay, stay}};
}

void SeamlessCore::mix() {
  const Matrix<2, 2> Pi = transition(seconds(stamp_ - mixed_));
  mixed_ = stamp_;
  const Matrix<2, 2> weights = filters::mixingWeights<2>(Pi, mu_);
  beliefs_ = filters::mixed<EskfState, 2>(beliefs_, weights);
  offsets_.mix(weights(row(kUwb), row(kUwb)));
}

// ---------------------------------------------------------------- epochs

std::string_view SeamlessCore::open(std::size_t mode) {
  if (epoch_ && epoch_->mode == mode && epoch_->stamp == stamp_) return {};
  const std::string_view event = close();
  if (watch_[kGnss].usable() && watch_[kUwb].usable()) {
    mix();
  } else if (!inUse(mode)) {
    rejoin(mode);
  }
  const Matrix<3, 3> prior = beliefs_[mode].covariance.topLeftCorner<3, 3>();
  epoch_ = Epoch{.mode = mode, .stamp = stamp_, .prior = prior};
  return event;
}

/// A mode comes back: from where the other one is, and less sure. The very first one has lost nothing.
void SeamlessCore::rejoin(std::size_t mode) {
  const bool first = !watch_[kGnss].lastApplied() && !watch_[kUwb].lastApplied();
  beliefs_[mode] = combined();
  if (!first) beliefs_[mode].covariance *= config_->imm.rejoin_inflation;
  if (mode == kUwb) offsets_.mix(0.0);
  mixed_ = stamp_;
}

IngestReport SeamlessCore::counted(IngestReport report) {
  if (report.verdict == Verdict::Applied) {
    ++epoch_->applied;
    believed_ = stamp_;
  }
  return report;
}

IngestReport SeamlessCore::take(const Eigen::Vector3d& antenna_map, const Matrix<3, 3>& R_claimed,
                                const Eigen::Vector3d& lever) {
  using Surprise = GnssUse::Surprise;
  const Surprise surprise = config_->gnss.surprise;
  const std::string_view event = open(kGnss);
  Belief<EskfState>& belief = beliefs_[kGnss];
  const auto innovation = pointFix(belief.mean, antenna_map, lever);
  if (surprise == Surprise::Adapt) {
    // Against the best belief, not against the filter that has only this receiver to go by.
    const Belief<EskfState> best = combined();
    const auto seen = pointFix(best.mean, antenna_map, lever);
    const double dt = watch_[kGnss].lastApplied() ? seconds(stamp_ - *watch_[kGnss].lastApplied()) : 0.0;
    gnss_scale_ = 1.0 + (gnss_scale_ - 1.0) * std::exp(-dt / config_->gnss.adapt_time);
    if (filters::normalisedSquare<EskfState, 3>(best, seen, gnss_scale_ * R_claimed) > gnss_gate_) {
      const double known = (seen.H * best.covariance * seen.H.transpose()).trace();
      gnss_scale_ = std::max(gnss_scale_, (seen.nu.squaredNorm() - known) / R_claimed.trace());
    }
  }
  const Matrix<3, 3> R = gnss_scale_ * R_claimed;
  const filters::Gate gate = surprise == Surprise::Gate ? filters::Gate{gnss_gate_} : filters::Gate{};
  const auto told = correctError<3>(belief, innovation, R, gate);
  IngestReport report{.verdict = told.verdict, .dof = 3, .nis = told.nis, .event = event};
  if (told.verdict == Verdict::Gated) report.reason = "the fix is too far from where the filter is";
  if (told.verdict == Verdict::Degenerate) report.reason = "the fix has no usable covariance";
  if (told.verdict == Verdict::Applied) {
    epoch_->evidence = {.d2 = told.nis, .log_det_S = logDet(told.S), .dof = 3};
    epoch_->information = R.inverse();
  }
  return counted(report);
}

std::optional<double> SeamlessCore::weighted(double nu, double state_variance, double variance) const {
  const double s = nu / std::sqrt(state_variance + variance);
  const std::optional<double> factor = filters::varianceFactor(config_->uwb.robust, s);
  return factor ? std::optional(variance * *factor) : std::nullopt;
}

void SeamlessCore::learnRanges(double nu, double expected_variance) {
  if (config_->uwb.adapt_count <= 0.0 || nu >= 0.0) return;
  const double seen = std::min(uwb_scale_ * square(nu) / expected_variance, kClipped * uwb_scale_);
  uwb_scale_ = std::max(1.0, uwb_scale_ + (seen - uwb_scale_) / config_->uwb.adapt_count);
}

IngestReport SeamlessCore::take(const RangeLink& link, double anchor_sigma) {
  const std::string_view event = open(kUwb);
  Belief<EskfState>& belief = beliefs_[kUwb];
  const RangeSeen seen = seenRange(belief.mean, link);
  if (seen.distance < kNearestAnchor) {
    return {
        .verdict = Verdict::Degenerate, .reason = "at the anchor a range has no direction", .event = event};
  }
  const auto expected = offsets_.expected(belief, seen.row, link.anchor);
  const double variance = uwb_scale_ * square(config_->uwb.sigma) + square(anchor_sigma);
  const double S = expected.variance + variance;
  IngestReport report{.verdict = Verdict::Gated,
                      .dof = 1,
                      .nis = square(expected.nu) / S,
                      .innovation = expected.nu,
                      .innovation_sigma = std::sqrt(S),
                      .event = event};
  const std::optional<double> R = weighted(expected.nu, expected.variance, variance);
  learnRanges(expected.nu, S);
  if (R) {
    report.verdict = correct(belief, seen.row, link.anchor, *R);
    if (report.verdict != Verdict::Applied) report.reason = "the range says nothing";
  } else {
    report.reason = "the range is too far from what the filter expects";
  }
  doubts_.note(config_->uwb.anchor_bias, stamp_, link.anchor, !R || *R > variance, offsets_);
  return counted(report);
}

/// Takes the range, and notes what it says of the mode.
Verdict SeamlessCore::correct(Belief<EskfState>& belief, const PoseRow& row, int anchor, double R) {
  const auto told = offsets_.take(belief, row, anchor, R);
  if (told.verdict != Verdict::Applied) return told.verdict;
  epoch_->evidence.d2 += told.nis;
  epoch_->evidence.log_det_S += std::log(told.S(0, 0));
  ++epoch_->evidence.dof;
  epoch_->information += row.by_position * row.by_position.transpose() / R;
  epoch_->pull += row.by_position * (told.nu[0] / R);
  return told.verdict;
}

// ---------------------------------------------------------------- probabilities

/// The evidence of the epoch, in the form wanted. In the position domain ranges count as the place they give
/// together; where they hardly give one, that place is hardly known.
double SeamlessCore::logLikelihoodOf(const Epoch& epoch) const {
  const LikelihoodForm form = config_->imm.likelihood;
  Evidence evidence = epoch.evidence;
  if (form == LikelihoodForm::PositionDomain && epoch.mode == kUwb) {
    const Matrix<3, 3> R = placeCovariance(epoch.information);
    const Eigen::Vector3d shift = R * epoch.pull;
    const Matrix<3, 3> S = epoch.prior + R;
    evidence = {shift.dot(S.llt().solve(shift)), logDet(S), 3};
  }
  return filters::logLikelihood(form, evidence, evidenceLimit(evidence.dof));
}

std::string_view SeamlessCore::close() {
  if (!epoch_) return {};
  const Epoch epoch = *epoch_;
  epoch_.reset();
  std::string_view event;
  if (epoch.applied > 0) {
    if (watch_[epoch.mode].applied(epoch.stamp)) {
      event = epoch.mode == kGnss ? "satellites join" : "the radio joins";
      log_likelihood_[epoch.mode].reset();
    }
    log_likelihood_[epoch.mode] = logLikelihoodOf(epoch);
    sigma_[epoch.mode] = placeSigma(epoch.information);
  } else if (watch_[epoch.mode].rejected(epoch.stamp)) {
    event = epoch.mode == kGnss ? "satellites are no longer believed" : "the radio is no longer believed";
    if (!anyUsable()) mu_ = Vector<2>::Unit(row(epoch.mode));
  }
  weigh();
  return event;
}

void SeamlessCore::weigh() {
  const double dt = seconds(stamp_ - weighed_);
  weighed_ = stamp_;
  if (!watch_[kGnss].usable() || !watch_[kUwb].usable()) return forceFloor();
  const Vector<2> c = filters::predictedModes<2>(transition(dt), mu_);
  Vector<2> mu = c;
  if (log_likelihood_[kGnss] && log_likelihood_[kUwb])
    mu = filters::bayes<2>(c, {*log_likelihood_[kGnss], *log_likelihood_[kUwb]});
  if (config_->variant == SeamlessConfig::Variant::Faimm) mu = fuzzy_->controlled<2>(mu_, mu);
  mu_ = filters::floored<2>(mu, config_->imm.usable_floor);
}

/// A mode that cannot be used has the least probability there is.
void SeamlessCore::forceFloor() {
  const std::size_t used = inUse(kGnss) ? kGnss : kUwb;
  if (inUse(other(used))) return;
  mu_[row(used)] = 1.0 - config_->imm.floor;
  mu_[row(other(used))] = config_->imm.floor;
  log_likelihood_[other(used)].reset();
}

SeamlessCore SeamlessCore::closed() const {
  SeamlessCore ahead = *this;
  ahead.close();
  return ahead;
}

}  // namespace pos::estimation
