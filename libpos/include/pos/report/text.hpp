#pragma once
/// Numbers and names as people read them. Nothing here ever prints "nan" or "-0.00".

#include <string>
#include <string_view>

#include "pos/core/stamp.hpp"

namespace pos::report {

/// What stands where a number is missing or not finite.
inline constexpr std::string_view kNoValue = "\u2013";

/// Fixed decimals, kNoValue for a number that is not finite.
std::string fixed(double value, int decimals);
/// Three digits that count and no more: 0.412, 4.12, 41.2, 412.
std::string rounded(double value);
/// A share as percent: 0.954 -> "95.4 %". Never "100.0 %" for less than all.
std::string percent(double fraction);
/// Shortest form for axis labels: 0.5, 20, 1e+06.
std::string tickText(double value);
/// "1 234 567".
std::string grouped(unsigned long long count);
/// "2024-05-03 14:07:12 UTC", or "12.5 s" for a log whose clock has no calendar.
std::string momentText(Stamp stamp);
/// "32 min 5 s".
std::string durationText(Duration duration);

/// Safe inside XML and HTML text and double-quoted attributes; control characters are dropped.
std::string escaped(std::string_view text);
/// At most `characters` of UTF-8 text, the last one an ellipsis where it was cut.
std::string shortened(std::string_view text, std::size_t characters);
/// Number of characters (code points) of UTF-8 text.
std::size_t characterCount(std::string_view text);

}  // namespace pos::report
