#pragma once
/// Ratios of earlier runs, and whether one of today is worse. A ratio belongs to a model of processor: wider
/// registers and other caches change both sides unequally.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/tools/ratios.hpp"

namespace pos::app {

/// A ratio may fall to this share of the recorded one.
inline constexpr double kLeastShare = 0.75;

struct RecordedRatio {
  std::string date;  ///< of the recording, YYYY-MM-DD
  std::string processor;
  std::string compiler;
  std::string pair;
  double ratio = 0.0;
};

/// A file of the columns date, processor, compiler, pair, ratio. Throws ConfigError for a file that is not
/// there, DataError with file and line for a row that is none.
std::vector<RecordedRatio> readHistory(const std::filesystem::path& file);
/// Adds rows at the end; the file must be there.
void appendHistory(const std::filesystem::path& file, const std::vector<RecordedRatio>& rows);

struct JudgedRatio {
  bench::Ratio ratio;
  std::optional<double> recorded;  ///< the last one of this processor
  bool worse = false;              ///< below kLeastShare of that
};
std::vector<JudgedRatio> judged(const std::vector<bench::Ratio>& ratios,
                                const std::vector<RecordedRatio>& history, const std::string& processor);

/// Name, family, model and stepping of this machine's first processor, for a name alone stands for several
/// generations; "unknown" where the system does not tell.
std::string processorModel();

}  // namespace pos::app
