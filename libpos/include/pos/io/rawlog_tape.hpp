#pragma once
/// A rawlog written while it is used: what the estimators get is what the file will give back later, to the
/// last bit.

#include <memory>
#include <string>
#include <vector>

#include "pos/core/measurement.hpp"

namespace pos::io {

/// A measurement on its way into a rawlog.
struct Taped {
  std::string bytes = {};  ///< to be appended to the file, uncompressed, whole objects
  /// What RawlogReader delivers for these bytes; stamps at 100 ns, ranges in single precision.
  std::vector<Measurement> read_back = {};
};

/// One tape for one file: the bytes of all its calls, one after the other, are an observation-only rawlog.
class RawlogTape {
 public:
  RawlogTape();
  RawlogTape(RawlogTape&&) noexcept;
  RawlogTape& operator=(RawlogTape&&) noexcept;
  ~RawlogTape();

  /// Throws DataError for a defective measurement; the tape is then as it was.
  Taped take(const Measurement& measurement);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pos::io
