#pragma once
/// Files named in configurations: where they are looked for, and messages that help to find the right name.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pos/core/error.hpp"

namespace pos::io {

/// The candidate most like `word` (letters dropped, added, swapped or changed; case ignored), or nothing when
/// none is near.
std::optional<std::string> nearestName(const std::string& word, const std::vector<std::string>& candidates);

/// `file` itself when it is a readable regular file. Otherwise throws ConfigError with the folder that was
/// searched and near names in it; `context` may say which key at which place named the file.
std::filesystem::path existingFile(const std::filesystem::path& file, const Complaint& context = {});

/// Whole content of a file that exists. Throws ConfigError.
std::string fileText(const std::filesystem::path& file);

/// The absolute form of a path written in a configuration file in `folder`. The prefix `mrpt-common:` stands
/// for `mrpt_share`, the share folder of Debian's package mrpt-common.
std::filesystem::path resolvedPath(const std::filesystem::path& path, const std::filesystem::path& folder,
                                   const std::filesystem::path& mrpt_share);

}  // namespace pos::io
