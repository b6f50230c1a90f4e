#pragma once
/// When the wheels are not to be believed, and when they are again.

#include <deque>
#include <optional>
#include <string_view>

#include "pos/core/stamp.hpp"
#include "pos/estimation/sins_configs.hpp"

namespace pos::estimation {

/// What one comparison of wheels and inertial unit showed.
struct SlipEvidence {
  Stamp stamp;
  bool disagrees =
      false;  ///< the positions' difference, or the change of the velocities', is beyond the gate
  /// m/s along the way: wheels gained so much on the accelerometers within a second; zero when that is noise.
  double jump = 0.0;
  double offset = 0.0;            ///< m/s along the way: what is left of it, while isolated
  bool velocities_agree = false;  ///< within the release gate, and so do the turns
  double velocity_sigma = 0.0;    ///< m/s, of the difference that agreed
  bool wheels_steady = false;     ///< wheels changed speed as the accelerometers say over the last second
  bool standing = false;          ///< the inertial unit is quiet and that is used: nothing drifts
  double position_sigma = 0.0;    ///< m, of the inertial position since
};

enum class SlipAction {
  Use,        ///< the update may be used
  Skip,       ///< leave this update out
  Isolate,    ///< from now on the wheels are left out
  Stay,       ///< still isolated
  Release,    ///< wheels agree again: anchor them at the inertial position
  ForceBack,  ///< the inertial velocity is worth nothing any more and the wheels are steady: take theirs
};

/// NORMAL -> SUSPECT -> ISOLATED -> REACQUIRE -> NORMAL.
class SlipWatch {
 public:
  explicit SlipWatch(const SlipConfig& config) : config_(config) {}

  SlipAction observe(const SlipEvidence& evidence);

  bool isolated() const { return since_.has_value(); }
  /// Isolated for so long, or so unsure since, that the position is not what it should be.
  bool degraded() const { return degraded_; }
  int isolations() const { return isolations_; }
  void forget();

 private:
  SlipAction whileIsolated(const SlipEvidence& evidence);
  void followJumps(const SlipEvidence& evidence);
  bool told(const SlipEvidence& evidence) const;
  SlipAction freed(SlipAction how);

  SlipConfig config_;
  std::deque<bool> recent_;
  std::optional<Stamp> since_;
  int agreements_ = 0;
  double entry_jump_ = 0.0;  // m/s, with which the slip began
  bool went_back_ = false;
  int isolations_ = 0;
  bool degraded_ = false;
};

}  // namespace pos::estimation
