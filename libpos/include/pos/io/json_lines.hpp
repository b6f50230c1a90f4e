#pragma once
/// Live measurements as text: one JSON object a line. Keys: docs/formats/json_lines.md.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "pos/core/measurement.hpp"

namespace pos::io {

/// The measurement of one line, checked like a file: every key known, every value of its type and within its
/// range, no defect. `name` stands for the source in messages. Throws DataError with line, column and key.
Measurement measurementFrom(std::string_view line, const std::string& name, int line_number = 1);

/// The sensor that a line names, be the rest as it may; empty where it names none.
std::string sensorNamedBy(std::string_view line);

/// The line that measurementFrom reads back to the same measurement, without the line break.
std::string jsonLine(const Measurement& measurement);

/// Cuts a stream of bytes, however it arrives, into lines.
class LineCutter {
 public:
  static constexpr std::size_t kLongest = 1U << 20;  ///< bytes; a scan of 10,000 beams needs a tenth

  struct Line {
    int number = 0;         ///< from 1
    std::string text = {};  ///< without its end
    bool too_long = false;  ///< then without its text
  };
  using Taker = std::function<void(const Line&)>;

  /// Gives every line that is complete now and not empty to `taker`.
  void feed(std::string_view bytes, const Taker& taker);
  /// The stream has ended: a last line without its end is a line too.
  void finish(const Taker& taker);

 private:
  void grow(std::string_view bytes);
  void give(const Taker& taker);

  std::string text_;
  bool too_long_ = false;
  int number_ = 1;
};

}  // namespace pos::io
