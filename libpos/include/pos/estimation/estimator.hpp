#pragma once
/// The one virtual interface of the library: an estimator eats measurements and answers for any moment.
///
/// Promises, each a test in tests/contract run over every estimator: all-or-nothing per measurement; the same
/// input gives bit-same output; the covariance stays finite, symmetric and positive semi-definite;
/// `estimateAt` changes nothing; an unknown sensor changes nothing; equal stamps are legal; stamps never go
/// back (a Sequencer in front merges streams; a measurement older than the state gets TooOld).

#include <optional>

#include "pos/core/belief.hpp"
#include "pos/core/estimate.hpp"
#include "pos/core/measurement.hpp"
#include "pos/core/verdict.hpp"

namespace pos::estimation {

class Estimator {
 public:
  Estimator() = default;
  Estimator(const Estimator&) = delete;
  Estimator& operator=(const Estimator&) = delete;
  Estimator(Estimator&&) = delete;
  Estimator& operator=(Estimator&&) = delete;
  virtual ~Estimator() = default;

  /// Forget everything and start from `prior` at `stamp` (planar pose in the map frame).
  virtual void reset(Stamp stamp, const Belief<Pose2>& prior) = 0;

  /// Take one measurement. Stamps must not decrease from call to call.
  [[nodiscard]] virtual IngestReport ingest(const Measurement& measurement) = 0;

  /// Where the vehicle is at `stamp`: the state carried forward (never backward) without changing it; nothing
  /// while not initialised or for a stamp before the state's.
  virtual std::optional<Estimate> estimateAt(Stamp stamp) const = 0;

  virtual Diagnostics diagnostics() const = 0;
};

}  // namespace pos::estimation
