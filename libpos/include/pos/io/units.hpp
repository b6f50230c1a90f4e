#pragma once
/// Units in keys: `range_std_m` is in metres, `yaw_deg` in degrees. The ending of the key is the only place
/// where a unit is written, so key, message, reference and conversion cannot disagree.

#include <string>
#include <string_view>

namespace pos::io {

/// What the ending of a key says.
struct Unit {
  std::string_view suffix = {};  ///< "_deg"; empty for a key without unit
  std::string_view symbol = {};  ///< "deg"
  long double to_si = 1.0L;      ///< SI value = written value * to_si
  bool used_by_options = true;   ///< false: known only to recognise a wrong unit ("_mm", "_rad")
};

/// Longest unit that `key` ends in; a Unit without suffix when there is none.
Unit unitOf(std::string_view key);

/// The key without its unit: "range_std" for "range_std_m" and for "range_std_mm".
std::string_view stemOf(std::string_view key);

/// `value` (SI) in the unit of the key, as the shortest text that reads back to the same double.
std::string numberText(double value, std::string_view key);

/// The SI value of a number written under the key. `text` has to be a number (see isNumber).
double siValue(std::string_view text, std::string_view key);

/// A decimal number: digits, one point, an exponent. No hexadecimal, no leading zero, no infinity.
bool isNumber(std::string_view text);
/// An optional sign and digits, no leading zero.
bool isWholeNumber(std::string_view text);

}  // namespace pos::io
