#pragma once
/// Which legs of the supports take part in the filter (Zheng et al. 2021, section 5.1): zones, modes, N and
/// d.

#include <optional>

#include "pos/estimation/shearer_configs.hpp"

namespace pos::estimation {

/// Along the face, towards end 2 or towards end 1.
enum class Travel { Forward, Backward };

/// Halves of what the scanner sees, fixed to the body: A towards end 2, B towards end 1.
enum class ZoneSide { A, B, Both };

/// Table 1 of the paper: the half used in each direction. Mode 1 to 9.
ZoneSide sideOf(int mode, Travel travel);

/// Legs are used between two distances along the track, so that `features` of them are in it at any time.
class LegWindow {
 public:
  LegWindow(const SelectionConfig& config, double spacing, int mode);

  /// A leg `along` metres towards end 2 of the scanner is taken up.
  bool takesUp(Travel travel, double along) const { return inside(travel, along, 0.0); }
  /// One in use stays so; a little wider, so that noise at the edge does not change it to and fro.
  bool keeps(Travel travel, double along) const { return inside(travel, along, kHysteresis); }

 private:
  bool inside(Travel travel, double along, double margin) const;

  static constexpr double kHysteresis = 0.03;  // m
  int mode_;
  double near_;
  double one_sided_;  // far edge where one side is used
  double two_sided_;
};

/// Where the shearer is in its cycle, from its station along the face.
class FaceProgress {
 public:
  enum class Event {
    None,
    Arrived,   ///< stands at the end of a pass
    Returned,  ///< stands there again after the end operation: the next pass begins
    Departed,  ///< left for the next pass without coming back first
  };

  FaceProgress(const FaceConfig& face, double zone_lag) : face_(face), zone_lag_(zone_lag) {}

  void start(double station);
  /// `dt` seconds later; station (m) and speed (m/s) along the face by the filter.
  Event step(double station, double speed, double dt);

  Travel travel() const { return travel_; }
  bool inPass() const { return in_pass_; }
  /// End of the face at which it is, or to which the pass leads: 1 or 2.
  int end() const { return end_; }
  /// Passes finished.
  int arrivals() const { return arrivals_; }
  bool standing() const { return standing_ >= kStandingTime; }
  /// The support at `station` may have moved since the shearer went by (zone I).
  bool mayHaveMoved(double station) const;

 private:
  double endStation() const { return end_ == 2 ? face_.length : 0.0; }
  double sign() const { return travel_ == Travel::Forward ? 1.0 : -1.0; }
  void turn(Travel travel, double station);

  static constexpr double kStandingTime = 1.0;  // s
  static constexpr double kLeft = 5.0;          // m from the end: the excursion has begun
  FaceConfig face_;
  double zone_lag_;
  Travel travel_ = Travel::Forward;
  bool in_pass_ = true;
  bool left_ = false;
  int end_ = 2;
  int arrivals_ = 0;
  double reached_ = 0.0;  // farthest along the travel
  double standing_ = 0.0;
};

/// Numbers of the supports from where their legs are. The row may creep; the numbering follows it.
class SupportLattice {
 public:
  SupportLattice(double spacing, double gate) : spacing_(spacing), gate_(gate) {}

  /// The support at `station` (m); nothing when it is about as near to two. `found` moves the row along.
  std::optional<int> numberAt(double station) const;
  void found(int number, double station);
  double stationOf(int number) const { return shift_ + number * spacing_; }

 private:
  double spacing_;
  double gate_;
  double shift_ = 0.0;
  bool known_ = false;
};

}  // namespace pos::estimation
