#pragma once
/// How much a scalar reading that surprises a filter is believed: two-sided, with a threshold of its own for
/// surprises upward, which is where blocked radio paths put theirs.

#include <optional>

namespace pos::filters {

struct RobustConfig {
  enum class Form {
    None,   ///< every reading counts in full
    Huber,  ///< variance times s / k0 beyond k0 (linear loss)
    Igg3,   ///< as Huber, and falling to nothing at the rejection (three-part, Yang 1999)
  } form = Form::Huber;
  double k0 = 1.5;         ///< sigmas; readings within are good
  double k0_upward = 1.0;  ///< the same for a positive innovation
  double k1 = 3.5;         ///< sigmas; readings beyond are rejected

  bool operator==(const RobustConfig&) const = default;
};
/// The same, or ConfigError.
RobustConfig validated(RobustConfig config);

/// Factor (1 or more) on the variance of a reading whose innovation lies `s` sigmas off, signed; nothing
/// where it is to be rejected.
std::optional<double> varianceFactor(const RobustConfig& config, double s);

}  // namespace pos::filters
