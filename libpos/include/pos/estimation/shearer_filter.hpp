#pragma once
/// The inertial filter with support legs under one mode of selection (docs/math/shearer.md): strapdown,
/// taking up, using and dropping legs, and what is done at the ends.

#include <optional>
#include <string_view>

#include "pos/core/estimate.hpp"
#include "pos/core/verdict.hpp"
#include "pos/estimation/leg_scene.hpp"
#include "pos/estimation/leg_selection.hpp"
#include "pos/estimation/shearer_state.hpp"

namespace pos::estimation {

/// What became of a leg.
struct LegReport {
  Verdict verdict = Verdict::Applied;
  bool taken_up = false;  ///< it is new: it told nothing yet
  double nis = 0.0;
  std::string_view reason = {};
};

class ShearerFilter {
 public:
  ShearerFilter(const ShearerConfig& config, int mode, Initialisation how = Initialisation::Correlated);

  /// Starts at a pose of the inertial unit; covariance of [phi, v, p, biases].
  void start(const ins::Earth& earth, const ins::NavigationState& nav,
             const Eigen::Matrix<double, 15, 15>& P);
  /// One inertial increment, biases and all. What happened at an end.
  FaceProgress::Event step(const ins::ImuIncrement& raw);
  /// The odometer has counted `way` m more.
  void rolled(double way) { rack_ = rack_.value_or(0.0) + way; }
  /// One leg, `age` seconds after the last increment, at `time` seconds of the filter's own clock.
  LegReport see(const Eigen::Vector3d& measured, const Eigen::Matrix3d& covariance, double age);

  /// The yaw of the mount turned by `eta` rad, and everything that followed from it so far.
  void turnMount(double eta);
  /// The correction of the mount that the first cut calls for (PICM, eq. 30 and 31), rad. At the first
  /// arrival at end 2.
  double picmAngle() const;

  const ShearerBelief& belief() const { return belief_; }
  const FaceProgress& progress() const { return progress_; }
  int mode() const { return mode_; }
  /// The inertial unit at the start.
  const ins::NavigationState& first() const { return first_; }
  double alongSpeed() const { return along_.dot(belief_.mean.nav.v_n.head<2>()); }
  /// Where the supports' legs in front of the scanner are expected, by the lattice that the filter follows.
  LegScene expectedLegs() const;
  double station() const { return along_.dot(belief_.mean.nav.coordinates.head<2>() - origin_); }
  /// s without a leg that agreed.
  double unaided() const { return unaided_; }
  bool degraded() const { return unaided_ > config_.legs.degraded_after; }
  int legs() const;
  /// Of the last increment, for the time since.
  const ins::ImuIncrement& lastIncrement() const { return last_; }
  /// Covariance brought up to the last increment.
  void catchUp();

 private:
  ins::ImuIncrement corrected(const ins::ImuIncrement& raw) const;
  FaceProgress::Event watchFace(double dt);
  void arrived();
  void alongCut();
  void compareRack();
  void fixPlace(const Eigen::Vector3d& place, const Eigen::Vector3d& sigma);
  void closeLoop(int end);
  void dropOutOfSight();
  LegReport update(int index, const LegSight& sight);
  LegReport takeUp(const LegSight& sight);

  ShearerConfig config_;
  int mode_;
  Initialisation how_;
  Eigen::Vector3d arm_;
  Eigen::Vector2d origin_;
  Eigen::Vector2d along_;
  LegWindow window_;
  FaceProgress progress_;
  SupportLattice lattice_;
  double gate_;
  ShearerBelief belief_;
  ins::NavigationState first_;   // at the start
  ins::NavigationState before_;  // at the last propagation, corrections taken in
  ins::ImuIncrement last_;
  double unpropagated_ = 0.0;
  double unwatched_ = 0.0;
  double unaided_ = 0.0;
  double straight_at_ = 0.0;    // m along the face: where the cut was last said to be on its line
  std::optional<double> rack_;  // m since the start; nothing where no odometer is heard
  bool rack_compared_ = false;
  bool swept_ = false;  // legs out of sight dropped since the last increment
};

}  // namespace pos::estimation
