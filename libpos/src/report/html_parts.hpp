#pragma once
/// What the pages of a run and of a campaign share. Internal to report.

#include <string>
#include <vector>

#include "pos/report/comparison.hpp"
#include "pos/report/figures.hpp"

namespace pos::report {

/// Everything up to the first heading; `title` is escaped here.
std::string pageStart(const std::string& title);
std::string pageEnd();

/// `tag` may carry attributes; `inner` is HTML.
std::string element(const std::string& tag, const std::string& inner);
/// One line of the list below the title.
std::string fact(const std::string& label, const std::string& value);
/// The box of what to know first; empty without warnings.
std::string warningBox(const std::vector<std::string>& warnings);
/// A table with a star at the best of a column; bounds in brackets go below their figure.
std::string tableHtml(const Comparison& table);
/// Every switch between models, one row each; empty for a run without.
std::string switchingSection(const eval::RunSummary& run);
std::string figureSection(const std::vector<NamedFigure>& figures);
/// Folded away; empty without a configuration.
std::string configSection(const std::string& resolved_config);

}  // namespace pos::report
