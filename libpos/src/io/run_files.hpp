#pragma once
/// The files of a run folder, for those who tell a run in another format. Private to io.

#include <filesystem>
#include <string>
#include <vector>

namespace pos::io {

/// The estimators of a run folder in the order of their names, by their <estimator>.tum beside
/// <estimator>.csv. Throws DataError for a folder that holds no run.
std::vector<std::string> estimatorsOf(const std::filesystem::path& folder);

}  // namespace pos::io
