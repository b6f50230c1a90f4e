#pragma once
/// The built browser interface: where it lies, and its files.

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace pos::app {

/// A file of the browser interface, or another whole answer.
struct Asset {
  std::string type = {};
  std::string bytes = {};
};
/// By path ("/index.html"); read once, so that no request ever names a file.
using Assets = std::map<std::string, Asset>;
/// Of a folder; a page that says what is missing where there is none.
Assets assetsOf(const std::optional<std::filesystem::path>& folder);

/// The folder that is named, else the one beside the installed program or in the source tree it was built in;
/// nothing where there is none. Throws DataError for a named folder without the page.
std::optional<std::filesystem::path> interfaceFolder(const std::string& named);

}  // namespace pos::app
