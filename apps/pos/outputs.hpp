#pragma once
/// Where results go: the terminal, JSON on standard output, a run folder.

#include <optional>
#include <string>
#include <vector>

#include "common.hpp"
#include "inputs.hpp"
#include "pos/eval/run_summary.hpp"
#include "pos/io/run_folder.hpp"

namespace pos::app {

struct OutputOptions {
  bool json = false;
  std::string folder;
  bool force = false;
  std::vector<std::string> requirements;
};

void addOutputs(CLI::App& verb, OutputOptions& options);

/// The run folder asked for with --out, if any.
std::optional<io::RunFolder> openRunFolder(const OutputOptions& options);

/// run.json, summary.json, report.html and the figures.
void writeRun(const io::RunFolder& folder, const Inputs& inputs, const eval::RunSummary& summary);

/// The comparison table, or the summary as JSON.
void show(const eval::RunSummary& summary, const OutputOptions& options, const io::RunFolder* folder,
          const Voice& voice);

/// Says how each requirement fared; throws RequirementMissed when one was missed.
void checkRequirements(const eval::RunSummary& summary, const std::vector<std::string>& requirements,
                       const Voice& voice);

}  // namespace pos::app
