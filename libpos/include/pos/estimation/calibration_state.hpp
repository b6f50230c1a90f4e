#pragma once
/// A slowly changing unknown of a sensor, as configurations give it.

namespace pos::estimation {

/// Its start value, how sure that is, and how it wanders. Sigma 0 holds it at its value (the state does not
/// exist).
struct CalibrationState {
  double value = 0.0;
  double sigma = 0.0;
  double walk_per_sqrt_s = 0.0;

  bool operator==(const CalibrationState&) const = default;
};

}  // namespace pos::estimation
