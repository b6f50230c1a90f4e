#pragma once
/// Runs the built command `pos` as a user would, in an empty folder of its own under the build tree.

#include <filesystem>
#include <string>
#include <vector>

namespace pos::replay {

/// What one run of the command left behind.
struct RunResult {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out;     ///< standard output
  std::string err;     ///< standard error

  int errLines() const;
};

/// A folder for the running test, empty at its start, kept when the test failed. Relative paths on the
/// command line start here.
class Bench {
 public:
  Bench();
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
  Bench(Bench&&) = delete;
  Bench& operator=(Bench&&) = delete;
  ~Bench();

  const std::filesystem::path& folder() const { return folder_; }

  /// Runs `pos` without a shell and with a bare environment; waits for its end.
  RunResult pos(const std::vector<std::string>& arguments) const;
  /// Starts it, sends `signal` as soon as `words` stand on its standard error, and waits for its end. Its
  /// standard output is thrown away.
  RunResult posStopped(const std::vector<std::string>& arguments, const std::string& words, int signal) const;

  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;  ///< empty when there is no such file

 private:
  std::filesystem::path folder_;
};

/// All bytes of a file; empty when it cannot be opened.
std::string contents(const std::filesystem::path& file);

/// A file of the source tree.
std::filesystem::path source(const std::string& relative);

/// Folder of Debian's mrpt-common, or an empty path where it is not installed.
std::filesystem::path datasets();

/// Folder with the recordings plaza1, lias_fast, hanyang_los_b4: POS_DATA_DIR, else ../shared/data beside the
/// source tree. Empty where there is none.
std::filesystem::path recordings();

}  // namespace pos::replay
