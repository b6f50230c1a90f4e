#pragma once
/// The chi-square distribution: gates, and two-sided bounds for NEES and NIS.

namespace pos {

/// Value x with P(chi2(dof) <= x) = probability. dof > 0 (need not be whole), 0 < probability < 1.
double chiSquareQuantile(double probability, double dof);
/// P(chi2(dof) <= x).
double chiSquareProbability(double x, double dof);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Two-sided interval that the mean of n independent chi2(dof) values falls into with `confidence`
/// (Bar-Shalom, Li, Kirubarajan 2001, section 5.4.2).
Interval meanChiSquareBounds(double confidence, double dof, double n);

}  // namespace pos
