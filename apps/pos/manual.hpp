#pragma once
/// The manual page pos(1), written from the tree of verbs.

#include <string>

#include "command_tree.hpp"

namespace pos::app {

/// In the language of troff's `man` macros. Options that nearly every verb has are told once.
std::string manualPage(const Command& root, const std::string& version);

}  // namespace pos::app
