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
  bool disagrees = false;         ///< the positions' or the velocities' difference is beyond the gate
  bool velocities_agree = false;  ///< within the release gate, and so do the turns
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
  ForceBack,  ///< isolated for too long and the wheels are steady: take their velocity
};

/// NORMAL -> SUSPECT -> ISOLATED -> REACQUIRE -> NORMAL.
class SlipWatch {
 public:
  explicit SlipWatch(const SlipConfig& config) : config_(config) {}

  SlipAction observe(const SlipEvidence& evidence);

  bool isolated() const { return since_.has_value(); }
  /// Isolated beyond the time or the sigma allowed: the position is not what it should be.
  bool degraded() const { return degraded_; }
  int isolations() const { return isolations_; }
  void forget();

 private:
  SlipAction whileIsolated(const SlipEvidence& evidence);
  SlipAction freed(SlipAction how);

  SlipConfig config_;
  std::deque<bool> recent_;
  std::optional<Stamp> since_;
  int agreements_ = 0;
  int isolations_ = 0;
  bool degraded_ = false;
};

}  // namespace pos::estimation
