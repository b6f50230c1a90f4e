#pragma once
/// Small parts that several estimators are made of. Private to estimation.

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "pos/core/square.hpp"
#include "pos/estimation/estimator.hpp"

namespace pos::estimation {

/// The report on a measurement that changed nothing.
inline IngestReport refusal(Verdict verdict, std::string_view reason) {
  return {.verdict = verdict, .reason = reason};
}

/// Refuses what no estimator looks at: a reading that is none, and one older than `last`, the newest stamp so
/// far.
inline std::optional<IngestReport> refusedUnseen(const Measurement& measurement,
                                                 const std::optional<Stamp>& last) {
  if (defect(measurement)) return refusal(Verdict::Degenerate, "the reading itself is not valid");
  if (last && measurement.stamp < *last) return refusal(Verdict::TooOld, "older than the state");
  return std::nullopt;
}

/// Whether a reading with this answer moves the estimator's time on: readings that it cannot use do not.
inline bool movesTimeOn(const IngestReport& report) {
  return report.verdict != Verdict::Unsupported && report.verdict != Verdict::Degenerate;
}

/// Adds the components of an axis vector: `stem`_x_`unit` and so on; `sigma` of the state's row `row` + axis.
template <class SigmaOfRow>
void addAxes(Diagnostics& values, const std::string& stem, const std::string& unit,
             const Eigen::Vector3d& components, int row, SigmaOfRow&& sigma) {
  const char* axes = "xyz";
  for (int i = 0; i < 3; ++i) {
    std::string name = stem + "_";
    name += axes[i];
    name += "_" + unit;
    values.push_back({std::move(name), components[i], sigma(row + i)});
  }
}

/// Covariance of three like, independent components of standard deviation `sigma`.
inline Matrix<3, 3> diagonal3(double sigma) {
  return square(sigma) * Matrix<3, 3>::Identity();
}

}  // namespace pos::estimation
