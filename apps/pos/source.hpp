#pragma once
/// Where the measurements of a run come from: a recording, or a scenario simulated on the way.

#include <memory>
#include <optional>

#include "inputs.hpp"
#include "pos/io/log_reader.hpp"

namespace pos::app {

/// Measurements in order of arrival, one at a time.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  Source(Source&&) = delete;
  Source& operator=(Source&&) = delete;
  virtual ~Source() = default;

  virtual std::optional<Measurement> next() = 0;
  /// How it ended; valid once next() returned nothing.
  virtual io::LogEnd end() const = 0;
  virtual io::LogTally tally() const = 0;
  /// What the user should know of how the source is read; mostly empty.
  virtual std::string note() const { return {}; }
};

/// What the configuration names. The inputs have to outlive it.
std::unique_ptr<Source> openSource(const Inputs& inputs);

}  // namespace pos::app
