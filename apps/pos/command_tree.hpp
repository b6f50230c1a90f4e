#pragma once
/// Verbs and options as plain values, for what is written about them: completions, manual page.

#include <string>
#include <vector>

namespace pos::app {

struct OptionShape {
  std::vector<std::string> names = {};    ///< "-q", "--quiet"; of an operand its name, "config"
  std::string argument = {};              ///< "TEXT", "FLOAT"; empty for a flag
  std::vector<std::string> choices = {};  ///< the words it takes, where only these are allowed
  std::string about = {};
  bool required = false;
  bool repeated = false;
};

struct Command {
  std::string path;  ///< as typed: "pos map check"
  std::string about;
  std::string footer;
  bool verb_required = false;  ///< does nothing without one of its verbs
  std::vector<OptionShape> options = {};
  std::vector<OptionShape> operands = {};
  std::vector<Command> verbs = {};
};

/// "check" of "pos map check".
std::string lastWord(const std::string& path);

/// The command, then all below it, each before its verbs.
std::vector<const Command*> flattened(const Command& root);

}  // namespace pos::app
