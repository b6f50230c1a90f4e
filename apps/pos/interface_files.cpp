#include "interface_files.hpp"

#include <fstream>

#include "pos/core/error.hpp"
#include "pos/io/files.hpp"

namespace pos::app {

namespace fs = std::filesystem;

Assets assetsOf(const std::optional<fs::path>& folder) {
  static const std::map<std::string, std::string> kTypes{{".html", "text/html; charset=utf-8"},
                                                         {".js", "text/javascript"},
                                                         {".css", "text/css"},
                                                         {".svg", "image/svg+xml"},
                                                         {".png", "image/png"},
                                                         {".json", "application/json"},
                                                         {".ico", "image/x-icon"},
                                                         {".woff2", "font/woff2"},
                                                         {".webmanifest", "application/manifest+json"}};
  Assets assets;
  if (!folder) {
    assets["/index.html"] = {
        kTypes.at(".html"),
        "<!doctype html><html lang=\"en\"><title>pos serve</title><h1>pos serve</h1>"
        "<p>The server runs. The browser interface is not installed: build it in apps/hmi "
        "(docs/howto/interface.md) and start again, or name its folder with "
        "--interface.</p><p><a href=\"/api/info\">/api/info</a></p></html>"};
    return assets;
  }
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(*folder)) {
    if (!entry.is_regular_file()) continue;
    const auto type = kTypes.find(entry.path().extension().string());
    std::ifstream file(entry.path(), std::ios::binary);
    assets["/" + fs::relative(entry.path(), *folder).generic_string()] = {
        type != kTypes.end() ? type->second : "application/octet-stream",
        std::string(std::istreambuf_iterator<char>(file), {})};
  }
  return assets;
}

std::optional<fs::path> interfaceFolder(const std::string& named) {
  if (!named.empty()) {
    io::existingFile(fs::path(named) / "index.html", Complaint{.key = "--interface"});
    return named;
  }
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  for (const char* place : {"../share/pos/hmi", "../../../apps/hmi/dist"}) {
    const fs::path folder = (program.parent_path() / place).lexically_normal();
    if (!failed && fs::exists(folder / "index.html")) return folder;
  }
  return std::nullopt;
}

}  // namespace pos::app
