#pragma once
/// The benchmark programs (bench/), which `pos bench` runs: where they are, and what they say.

#include <filesystem>
#include <string>
#include <vector>

namespace pos::app {

/// The folder named, else that of the running program or ../libexec/pos beside it. Throws UsageError where
/// there is no program bench_*.
std::filesystem::path benchFolder(const std::string& named);

/// Names of the programs bench_* in a folder, sorted.
std::vector<std::string> benchPrograms(const std::filesystem::path& folder);

/// Runs a program to its end and gives its standard output; its standard error is thrown away. Throws
/// DataError when it cannot be started or fails.
std::string outputOf(const std::filesystem::path& program, const std::vector<std::string>& arguments);

}  // namespace pos::app
