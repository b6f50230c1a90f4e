#pragma once
/// `pos convert log`: recordings from one form into another.

#include "common.hpp"

namespace pos::app {

void addConvertLog(CLI::App& parent, const Verbs& verbs);

}  // namespace pos::app
