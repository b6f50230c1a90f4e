#pragma once
/// Several beliefs about where the vehicle is, kept until one wins.

#include <optional>
#include <vector>

#include "pos/estimation/hypotheses.hpp"
#include "pos/estimation/range_models.hpp"

namespace pos::estimation {

using RangeHypothesis = Hypothesis<RangeState>;

/// What a range did to the best hypothesis.
using RangeCorrection = filters::Correction<1>;

/// One range as a bank takes it.
struct RangeReading {
  RangeGeometry geometry;
  double range = 0.0;     ///< m
  double variance = 0.0;  ///< m^2
};

/// A passage fix as a bank takes it. Without a heading the third row and column of the covariance mean
/// nothing.
struct FixReading {
  SeenPoint seen = {};
  std::optional<double> yaw = {};                      ///< rad
  Matrix<3, 3> covariance = Matrix<3, 3>::Identity();  ///< x, y (m, map axes), yaw (rad)
  double age = 0.0;                                    ///< s, stamp of the fix minus stamp of the state
  BodyVelocity odometry_velocity = {};
};

/// What a fix did to the best hypothesis.
struct FixCorrection {
  Verdict verdict = Verdict::Applied;
  int dof = 0;
  double nis = 0.0;
};

/// A bank of hypotheses; never empty once started.
class RangeBank : public HypothesisBank<RangeState> {
 public:
  using HypothesisBank::HypothesisBank;

  /// Corrects every hypothesis by one range and says what it did to the best. A range that passes the gate
  /// but moves a hypothesis by a good part of its uncertainty forks it into one that believes the range and
  /// one that does not; later ranges decide (a Gaussian sum, Alspach and Sorenson 1972).
  RangeCorrection correct(const RangeLayout& layout, const RangeReading& reading, filters::Gate gate);

  /// Corrects every hypothesis by a fix, gated at the chi-square quantile `confidence`. A fix may be very
  /// uncertain along one direction (a roadway); then it tells of the other one only.
  FixCorrection correct(const RangeLayout& layout, const FixReading& fix, double confidence);
};

}  // namespace pos::estimation
