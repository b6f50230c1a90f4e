#include "starter_file.hpp"

#include <filesystem>

#include "pos/core/error.hpp"

namespace pos::app {

void StarterFile::requireFree() const {
  if (force || path.empty() || !std::filesystem::exists(path)) return;
  throw UsageError(Complaint{.what = "the file is there already",
                             .key = "--out",
                             .got = path,
                             .suggestion = "name another file, or add --force to replace it"});
}

void StarterFile::write(const std::string& text) const {
  if (path.empty()) return print(text);
  requireFree();
  writeFile(path, text);
}

void addStarterFile(CLI::App& verb, StarterFile& file) {
  verb.add_option("--out", file.path, "File to write, instead of standard output");
  verb.add_flag("--force", file.force, "Replace the file if it is there");
}

}  // namespace pos::app
