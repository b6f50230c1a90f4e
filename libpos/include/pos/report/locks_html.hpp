#pragma once
/// The page about a run of locks.

#include <string>
#include <vector>

#include "pos/report/time_distance.hpp"

namespace pos::report {

struct LockFigure {
  std::string name = {};
  std::string value = {};  ///< with its unit
};

struct LockReport {
  std::string title = {};
  std::string map = {};
  std::vector<LockFigure> figures = {};
  std::vector<std::string> warnings = {};  ///< findings of the audit, deadlocks
  TimeDistance diagram = {};
};

std::string locksHtml(const LockReport& run, const std::string& resolved_config);

}  // namespace pos::report
