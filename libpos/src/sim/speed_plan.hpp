#pragma once
/// Drive steps, worked out: speed and way at any time.

#include <functional>
#include <string>
#include <vector>

#include "pieces.hpp"

namespace pos::sim {

class SpeedPlan {
 public:
  /// `key` names the list in messages; step i is key[i]. Throws ConfigError.
  SpeedPlan(double start_speed, const std::vector<DriveStep>& steps, const std::string& key);

  /// Way since 0, speed, acceleration; t within [0, duration].
  SpeedPiece::Value at(double t) const;
  double duration() const { return duration_; }
  std::size_t size() const { return pieces_.size(); }
  const SpeedPiece& piece(std::size_t i) const { return pieces_[i]; }
  double startOf(std::size_t i) const { return starts_[i]; }
  /// Piece ends and corners within (0, duration).
  const std::vector<double>& breaks() const { return breaks_; }

  /// Every time at which the way passes `way`, each found to rounding. O(steps); for setting up.
  std::vector<double> timesAt(double way) const;
  /// The smallest and the largest way of the whole plan.
  struct Reach {
    double lowest = 0.0;
    double highest = 0.0;
  };
  Reach reach() const;

 private:
  /// Times between which the way only grows or only shrinks: piece ends and turning points, 0 and the end.
  std::vector<double> turningTimes() const;

  std::vector<SpeedPiece> pieces_;
  std::vector<double> starts_;
  std::vector<double> ways_;
  std::vector<double> breaks_;
  double duration_ = 0.0;
};

}  // namespace pos::sim
