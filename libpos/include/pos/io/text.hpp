#pragma once
/// Numbers and stamps as text, the same bytes under every locale.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pos/core/stamp.hpp"

namespace pos::io::text {

/// Without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text);
/// The parts between blanks and tabs.
std::vector<std::string_view> words(std::string_view text);

/// The whole text as a finite number; nothing for "", "1.5m", "nan", "inf" and numbers beyond a double.
std::optional<double> number(std::string_view text);
/// The whole text as a whole number: "7", "+7", "-7", also "7.0" as tables often hold ids.
std::optional<std::int64_t> integer(std::string_view text);

/// What the last digit before the decimal point of a time counts.
enum class TimeUnit { Seconds, Milliseconds, Microseconds, Nanoseconds };
/// A time as a duration since its origin, exact to the nanosecond (digits beyond it are rounded to nearest,
/// an exponent costs exactness). Nothing for text that is no number or lies beyond +-4.6e9 s.
std::optional<Duration> duration(std::string_view text, TimeUnit unit = TimeUnit::Seconds);
/// Seconds with nine decimals, exact.
std::string stampSeconds(Stamp stamp);

/// With a fixed number of decimals; never "-0.000".
std::string fixed(double value, int decimals);
/// The shortest text that reads back as the same double; never "-0".
std::string shortest(double value);

/// As a CSV cell: in quotes where it holds a comma, a quote, a leading '#' or blanks at its ends; line breaks
/// become blanks, for a row is one line.
std::string csvCell(std::string_view text);

/// "a, b, c".
std::string joined(const std::vector<std::string>& words);
/// "did you mean 'range_m'?" for the candidate nearest to `word`, or "" where none is near.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace pos::io::text
