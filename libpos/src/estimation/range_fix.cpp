/// Passage fixes in the bank of `range_odometry`.

#include <Eigen/LU>
#include <cmath>

#include "pos/core/chi_square.hpp"
#include "pos/estimation/range_bank.hpp"

namespace pos::estimation {
namespace {

using likelihood::kOutlierShare;
constexpr double kOutlierReach = 10.0;  // sigmas of the fix over which a bad one is spread evenly

/// log of the likelihood of nu under N(0, S), and of a bad fix spread over `kOutlierReach` sigmas of R,
/// joined.
template <int M>
double logLikelihood(const filters::Correction<M>& c, const Matrix<M, M>& R) {
  const double good = std::log(1.0 - kOutlierShare) - 0.5 * c.nis - 0.5 * std::log(c.S.determinant()) -
                      0.5 * M * std::log(2.0 * kPi);
  const double bad =
      std::log(kOutlierShare) - 0.5 * std::log(R.determinant()) - M * std::log(2.0 * kOutlierReach);
  return logSum(good, bad);
}

template <int M>
filters::Innovation<RangeState, M> innovationOf(const RangeState& x, const RangeLayout& layout,
                                                const FixReading& fix) {
  if constexpr (M == 2) {
    return positionInnovation(x, layout, fix.seen, fix.age, fix.odometry_velocity);
  } else {
    return poseInnovation(x, layout, fix.seen, *fix.yaw, fix.age, fix.odometry_velocity);
  }
}

template <int M>
FixCorrection correctOne(RangeHypothesis& h, const RangeLayout& layout, const FixReading& fix,
                         double confidence) {
  const Matrix<M, M> R = fix.covariance.topLeftCorner<M, M>();
  const auto done = filters::correct(h.belief, innovationOf<M>(h.belief.mean, layout, fix), R,
                                     filters::Gate{chiSquareQuantile(confidence, M)});
  if (done.verdict != Verdict::Degenerate) h.log_weight += logLikelihood<M>(done, R);
  return {done.verdict, M, done.nis};
}

}  // namespace

FixCorrection RangeBank::correct(const RangeLayout& layout, const FixReading& fix, double confidence) {
  FixCorrection told;
  for (std::size_t i = 0; i < size(); ++i) {
    RangeHypothesis& h = hypotheses()[i];
    const FixCorrection done =
        fix.yaw ? correctOne<3>(h, layout, fix, confidence) : correctOne<2>(h, layout, fix, confidence);
    if (i == bestIndex()) told = done;
  }
  settle();
  return told;
}

}  // namespace pos::estimation
