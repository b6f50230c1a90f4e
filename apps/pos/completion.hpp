#pragma once
/// Completion of the command line in a shell, written from the tree of verbs.

#include <string>

#include "command_tree.hpp"

namespace pos::app {

/// For the folders where the shells look: share/bash-completion/completions/pos,
/// share/zsh/vendor-completions/_pos, share/fish/vendor_completions.d/pos.fish. They need nothing but the
/// shell.
std::string bashCompletion(const Command& root);
std::string zshCompletion(const Command& root);
std::string fishCompletion(const Command& root);

}  // namespace pos::app
