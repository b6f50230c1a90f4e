#pragma once
/// Chamber passages: is the chamber that was named the one that is passed, and what does it tell the
/// estimator?

#include <string>
#include <string_view>
#include <vector>

#include "pos/core/measurement.hpp"
#include "pos/interval/road_tracker.hpp"

namespace pos::interval {

/// A reader, radio or camera says that the vehicle is beside this chamber now.
struct ChamberSighting {
  Stamp stamp = {};
  std::string chamber = {};                          ///< id
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< m, FLU: where on the vehicle the reader is
};

struct PassageRules {
  double gate_sigmas = 3.3;     ///< sightings farther off than this are wrong (99.9 %)
  double stamp_sigma = 0.05;    ///< s, of the moment of passing; adds speed times this to the chamber's sigma
  double missed_margin = 5.0;   ///< m beyond the gate before a chamber counts as missed
  double repeat_within = 10.0;  ///< m of travel within which the same chamber is the same passage
  double odometer_scale = 0.01;  ///< share of the way, how well the way between two sightings is known
  double vertical_sigma = 1.0;   ///< m
};
PassageRules validated(PassageRules rules);

/// What is thought of a sighting.
enum class PassageVerdict {
  Accepted,
  UnknownChamber,  ///< the map has none of this id
  NoPosition,      ///< the road is not known yet
  NotOnTheWay,     ///< no path that the vehicle may be on passes it: not the next on the graph
  OutOfReach,      ///< it is on the way, but not here
  Ambiguous,       ///< it fits, but so does another chamber: it needs a second sighting
  Repeated         ///< the same passage told again
};
std::string_view name(PassageVerdict verdict);

struct Passage {
  PassageVerdict verdict = PassageVerdict::NoPosition;
  double off = 0.0;                     ///< m, chamber minus estimated reader along the path
  double off_sigma = 0.0;               ///< m
  std::optional<Measurement> fix = {};  ///< with Accepted: position with full covariance, for `ingest`
};

/// Sensor label of the fixes.
inline constexpr const char* kPassageSensor = "chamber";

class PassageCheck {
 public:
  PassageCheck(const map::Network& network, const PassageRules& rules);

  /// Judges a sighting; the road must have been told of an estimate at (nearly) its stamp. An accepted one is
  /// a witness of its branch.
  Passage judged(const ChamberSighting& sighting, RoadTracker& road);
  /// Chambers that have been passed without an accepted sighting since the last call, in order.
  std::vector<std::string> missed(const RoadTracker& road);

 private:
  struct Place {
    const map::Chamber* chamber = nullptr;
    map::RoadwayIndex roadway = 0;
  };
  /// A sighting of which it is remembered how far the vehicle had travelled.
  struct Remembered {
    Place place = {};
    double travelled = 0.0;
    double at = 0.0;  ///< m, path coordinate
    double sigma = 0.0;
  };
  const Place* find(const std::string& chamber) const;
  /// `reader`: m, path coordinate of the reader as estimated.
  bool ambiguous(const Remembered& now, double reader, const RoadHypothesis& on, double reach) const;
  bool confirmed(const Remembered& now) const;
  bool ownSide(const Place& place, const RoadHypothesis& on) const;
  double sigmaOf(const Place& place, const RoadTracker& road) const;
  Measurement fixFor(const Remembered& now, const RoadHypothesis& on, const ChamberSighting& sighting) const;

  map::Network network_;
  PassageRules rules_;
  std::vector<Place> places_;
  std::optional<Remembered> accepted_;
  std::optional<Remembered> doubtful_;
  std::optional<double> watched_to_;  // path coordinate up to which missed chambers have been told
  std::vector<std::string> seen_;     // accepted since then
};

}  // namespace pos::interval
