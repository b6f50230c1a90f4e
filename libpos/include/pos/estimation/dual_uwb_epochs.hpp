#pragma once
/// `dual_uwb`, variants `snapshot`, `differential` and `rigid`: a pose from the ranges of one moment, without
/// any model of motion (spec A, sections 2.4 and 2.5).

#include <memory>
#include <vector>

#include "pos/estimation/estimator.hpp"
#include "pos/estimation/uwb_epoch.hpp"
#include "pos/estimation/uwb_links.hpp"
#include "pos/uwb/dual_tag.hpp"

namespace pos::estimation {

/// One pose that the ranges of an epoch fit.
struct EpochPose {
  Belief<Pose2> pose;
  double cost = 0.0;  ///< chi^2
  /// Where the tags were measured, for the differential variant.
  Eigen::Vector2d left_map = Eigen::Vector2d::Zero();
  Eigen::Vector2d right_map = Eigen::Vector2d::Zero();
};

/// A pose of one epoch, and whatever else fits as well.
struct EpochFix {
  Stamp stamp = {};
  std::vector<EpochPose> poses;  ///< one at least, the likelier first; more = not told apart yet

  const Belief<Pose2>& best() const { return poses.front().pose; }
  /// Nothing else fits.
  bool certain() const { return poses.size() == 1; }
};

class DualUwbEpochs : public Estimator {
 public:
  /// Throws ConfigError when the map has no anchors.
  DualUwbEpochs(const DualUwbConfig& config, std::shared_ptr<const map::TunnelMap> map);

  void reset(Stamp stamp, const Belief<Pose2>& prior) override;
  /// A range is Applied when it was taken into an epoch. The epoch is solved when it has as many ranges as
  /// the one before, or when a range of the next one comes.
  [[nodiscard]] IngestReport ingest(const Measurement& measurement) override;
  /// The last epoch's pose, held, and less sure by what the vehicle may have moved since.
  std::optional<Estimate> estimateAt(Stamp stamp) const override;
  Diagnostics diagnostics() const override;

 private:
  IngestReport take(Stamp stamp, const BeaconRange& range);
  template <class Reading>
  IngestReport take(Stamp, const Reading&) {
    return {.verdict = Verdict::Unsupported, .reason = "this variant of dual_uwb takes ranges only"};
  }

  bool belongs(Stamp stamp, const UwbReading& reading) const;
  void finishEpoch();
  std::string_view solve();
  std::optional<EpochFix> rigidFix() const;
  std::optional<EpochFix> snapshotFix() const;
  EpochFix resolved(EpochFix fix) const;
  uwb::TagPair pair() const;
  uwb::TagFixes tagFixes(const TagMount& tag) const;
  void differentiate(EpochFix& fix);
  std::optional<PlanarTwist> twistBetween(const EpochFix& before, const EpochFix& now) const;

  DualUwbConfig config_;
  RoadwayTest roadway_;
  UwbLinks links_;
  uwb::ResidualTest test_;
  UwbEpoch epoch_;
  int expected_ = uwb::kMaxRanges + 1;  // ranges of the epoch before; the first epoch waits for the second
  std::optional<EpochFix> previous_;    // of an earlier epoch
  std::optional<EpochFix> current_;     // of this epoch, or else the last one
  std::optional<PlanarTwist> twist_;
  bool solved_ = false;  // current_ is of this epoch
  std::optional<uwb::DifferentialMapper> mapper_previous_;
  std::optional<uwb::DifferentialMapper> mapper_current_;
  std::optional<Stamp> last_stamp_;
  int epochs_ = 0;
  int unsolved_ = 0;
  int turned_round_ = 0;
};

}  // namespace pos::estimation
