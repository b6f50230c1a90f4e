#pragma once
/// viewer.html: the browser interface with a finished run inside, one file that opens from disk.

#include <filesystem>
#include <optional>
#include <string>

#include "inputs.hpp"

namespace pos::app {

inline constexpr const char* kViewerFile = "viewer.html";

/// The page to fill (apps/hmi/README.md), of the built interface: `named` as for interfaceFolder. Nothing
/// where the interface is not built; DataError where the named folder lacks the page.
std::optional<std::string> viewerTemplate(const std::string& named);

/// Writes viewer.html into the folder of a finished run. Long tracks are thinned, so that the file stays one
/// that can be sent.
void writeViewer(const std::filesystem::path& folder, const Inputs& inputs, const std::string& page);

}  // namespace pos::app
