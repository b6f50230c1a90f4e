#include "command_tree.hpp"

namespace pos::app {

std::string lastWord(const std::string& path) {
  return path.substr(path.find_last_of(' ') + 1);
}

std::vector<const Command*> flattened(const Command& root) {
  std::vector<const Command*> all{&root};
  for (const Command& verb : root.verbs) {
    const auto below = flattened(verb);
    all.insert(all.end(), below.begin(), below.end());
  }
  return all;
}

}  // namespace pos::app
