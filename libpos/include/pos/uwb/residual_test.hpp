#pragma once
/// Do the ranges of one fit agree with each other? The chi-square test of the residuals, its quantiles looked
/// up once so that a fit costs no special functions.

#include <array>

namespace pos::uwb {

/// Most ranges that one fit takes; also the width of its mask of used ranges.
inline constexpr int kMaxRanges = 32;

/// A difference of chi^2 that rules the worse of two fits out (1 in 1000, two degrees of freedom).
inline constexpr double kRuledOut = 13.8;

class ResidualTest {
 public:
  /// `significance` is the share of good fits that fail, 0 < significance < 1.
  explicit ResidualTest(double significance = 0.001);
  /// The test that every fit passes: all ranges count, whatever they say.
  static ResidualTest off();

  /// True when a sum of squared whitened residuals with `dof` redundant ranges is no surprise. Without
  /// redundancy nothing can be tested and the answer is yes.
  bool passes(double chi_square, int dof) const {
    return dof <= 0 || chi_square <= threshold_[static_cast<std::size_t>(dof)];
  }
  /// The largest whitened residual, squared, that a single good range shows.
  double single() const { return threshold_[1]; }

 private:
  std::array<double, kMaxRanges + 1> threshold_{};
};

}  // namespace pos::uwb
