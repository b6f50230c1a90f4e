#pragma once
/// When an anchor's range offset becomes a state, and how it behaves then. SI units.

namespace pos::estimation {

/// An offset of one anchor's ranges as a further state, from the time that the anchor keeps surprising.
struct AnchorBiasConfig {
  double sigma = 0.0;       ///< m, how large it may be; 0 = no such states
  double time = 5.0;        ///< s, correlation time (Gauss-Markov)
  double after = 1.0;       ///< s of surprise before the state is added
  double drop_after = 5.0;  ///< s without surprise before it is dropped

  bool operator==(const AnchorBiasConfig&) const = default;
};
/// The same, or ConfigError.
AnchorBiasConfig validated(AnchorBiasConfig config);

}  // namespace pos::estimation
