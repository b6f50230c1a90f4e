#pragma once
/// A file that a person goes on with by hand: what is there already is not replaced unasked.

#include <string>

#include "common.hpp"

namespace pos::app {

struct StarterFile {
  std::string path;
  bool force = false;

  /// Throws UsageError when the file is there already and --force was not given.
  void requireFree() const;
  /// To standard output where no path is given.
  void write(const std::string& text) const;
};

/// --out and --force.
void addStarterFile(CLI::App& verb, StarterFile& file);

}  // namespace pos::app
