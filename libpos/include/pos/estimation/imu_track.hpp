#pragma once
/// Asynchronous readings between the samples of an inertial unit. A reading that comes between two samples is
/// met with the last sample held; when the next sample comes, what was applied ahead is taken off it, so that
/// no turn and no velocity is counted twice or lost.

#include <optional>

#include "pos/ins/mechanisation.hpp"

namespace pos::estimation {

class ImuTrack {
 public:
  /// What the filter has to do: take an increment, then go straight on for a while.
  struct Share {
    ins::ImuIncrement increment;
    double coast = 0.0;       ///< s
    bool was_silent = false;  ///< the unit had been silent for too long
  };

  /// For a reading `dt` seconds after the filter's time, before the next sample.
  Share held(double dt) const;
  /// The share was used.
  void note(const Share& share);
  /// A sample that covers raw.dt, since the sample before.
  Share arrived(const ins::ImuIncrement& raw);

  /// rad/s, of the last sample.
  Eigen::Vector3d rate() const { return rate_ ? rate_->angle : Eigen::Vector3d::Zero(); }
  void forget() { *this = {}; }

 private:
  std::optional<ins::ImuIncrement> rate_;  // of one second
  ins::ImuIncrement ahead_;                // applied since the last sample
  ins::ImuIncrement owed_;                 // measured, but there was no time left to apply it in
};

}  // namespace pos::estimation
