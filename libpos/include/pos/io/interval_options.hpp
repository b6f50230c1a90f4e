#pragma once
/// The configuration of interval positioning in a run.

#include <optional>
#include <string>
#include <vector>

#include "pos/interval/interval_tracker.hpp"
#include "pos/interval/passages.hpp"
#include "pos/interval/road_aid.hpp"
#include "pos/io/options.hpp"
#include "pos/map/lock_intervals.hpp"

namespace pos::io {

/// What becomes of the chamber passages of the log.
enum class PassageUse {
  AsTold,  ///< they go to the estimator as they are
  None,    ///< they are kept from it
  Checked  ///< the road is asked first; what passes goes on with the chamber's place and full covariance
};

/// What the map gives back to one estimator; absent: as for all.
struct IntervalAid {
  std::string estimator = {};
  std::optional<bool> aiding = {};
  std::optional<PassageUse> passages = {};

  bool operator==(const IntervalAid&) const = default;
};

struct IntervalsConfig {
  int merge = 1;                  ///< every so many chambers are a boundary
  double straight_within = 0.35;  ///< rad
  double heading_sigma = 0.0873;  ///< rad, between a vehicle and its roadway
  double commit = 0.99;           ///< probability
  double look_ahead = 20.0;       ///< m
  double lost_after = 2.0;        ///< s
  double certain = 0.9;           ///< probability
  double listed = 1e-4;           ///< probability
  bool aiding = false;            ///< fixes across the road go back to the estimators
  double aiding_rate = 1.0;       ///< Hz at most
  PassageUse passages = PassageUse::AsTold;
  std::vector<IntervalAid> estimators = {};

  map::DivisionRules division() const;
  interval::MatchRules match() const;
  interval::IntervalRules rules() const;
  interval::RoadAidRules aid() const;
  bool aids(const std::string& estimator) const;
  PassageUse passagesOf(const std::string& estimator) const;

  bool operator==(const IntervalsConfig&) const = default;
};

OptionTable<IntervalsConfig> intervalsOptions();

}  // namespace pos::io
