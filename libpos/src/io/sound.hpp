#pragma once
/// What no log may hold. Private to io.

#include <string>

#include "pos/core/error.hpp"
#include "pos/core/measurement.hpp"

namespace pos::io {

/// Throws DataError, naming the log under construction, for a measurement with a defect.
inline void requireSound(const Measurement& measurement, const std::string& log) {
  const auto reason = defect(measurement);
  if (!reason) return;
  throw DataError(Complaint{.what = "a defective measurement is not written",
                            .place = {.file = log},
                            .key = measurement.sensor,
                            .got = *reason});
}

}  // namespace pos::io
