#pragma once
/// What became of a measurement. Nothing is ignored in silence: every verdict is counted and shown.

#include <array>
#include <cstdint>
#include <string_view>

namespace pos {

enum class Verdict : std::uint8_t {
  Applied,         ///< it changed the estimate
  Gated,           ///< it disagrees with the prediction beyond the gate
  TooOld,          ///< its stamp lies before what can still be changed
  Unsupported,     ///< this estimator has no use for it, or was told not to use it
  Degenerate,      ///< the reading or its geometry says nothing (NaN, unknown anchor, no information)
  NotInitialised,  ///< the estimator does not yet know where it is
};

inline constexpr std::array kVerdicts{Verdict::Applied,     Verdict::Gated,      Verdict::TooOld,
                                      Verdict::Unsupported, Verdict::Degenerate, Verdict::NotInitialised};

std::string_view name(Verdict verdict);

/// What `ingest` says of one measurement.
struct IngestReport {
  Verdict verdict = Verdict::Unsupported;
  /// Degrees of freedom of the innovation; 0 where there was none (then nis and innovation mean nothing).
  int dof = 0;
  /// Normalised innovation squared, nu^T S^-1 nu, before any robust weighting.
  double nis = 0.0;
  /// Innovation and its standard deviation for scalar readings (m for ranges).
  double innovation = 0.0;
  double innovation_sigma = 0.0;
  /// Why, in a few words, where the verdict is not Applied. Points at a string literal.
  std::string_view reason = {};
  /// Something worth a line in the run's events ("gate opened"), empty otherwise. Points at a string literal.
  std::string_view event = {};
};

}  // namespace pos
