#pragma once
/// What every verb shares: the options that mean the same everywhere, and the way to talk to the user.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace pos::app {

/// For options that take a count or a seed.
inline const CLI::Validator kWholeNumber{
    [](std::string& text) {
      const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
      return digits ? std::string{} : "'" + text + "' is not a whole number from 0 on";
    },
    ""};

/// Documented in docs/reference/command_line.md. 1 to 5 come from pos::Error::exitCode().
enum class ExitCode { Ok = 0, Internal = 1, Usage = 2, Config = 3, Missed = 4, Data = 5, Interrupted = 130 };

/// How loudly to speak on standard error. Standard output carries only what was asked for.
struct Voice {
  bool quiet = false;
  bool verbose = false;

  void say(const std::string& text) const;     ///< unless quiet
  void detail(const std::string& text) const;  ///< only when verbose
  void warn(const std::string& text) const;    ///< always
};

void addVoice(CLI::App& verb, Voice& voice);

/// Writes to standard output.
void print(const std::string& text);
/// What was printed so far reaches whoever waits for it.
void flushOutput();
/// Writes a whole file; throws DataError when the disk takes no more.
void writeFile(const std::filesystem::path& path, const std::string& text);

/// Share folder of Debian's mrpt-common: POS_MRPT_SHARE, or where the package puts it.
std::filesystem::path mrptShare();

/// What the build knows of itself.
std::string version();
std::string gitHash();

/// Each verb adds itself; its callback returns through `code`.
struct Verbs {
  CLI::App* app;
  Voice* voice;
  ExitCode* code;
};
void addReplay(const Verbs& verbs);
void addCampaign(const Verbs& verbs);
void addEvaluate(const Verbs& verbs);
void addConvert(const Verbs& verbs);
void addCalibrate(const Verbs& verbs);
void addInfo(const Verbs& verbs);
void addConfig(const Verbs& verbs);
void addReport(const Verbs& verbs);
void addSimulate(const Verbs& verbs);
void addMap(const Verbs& verbs);
void addLocks(const Verbs& verbs);
void addServe(const Verbs& verbs);
void addVersion(const Verbs& verbs);
void addCompletion(const Verbs& verbs);
void addMan(const Verbs& verbs);
void addBench(const Verbs& verbs);

}  // namespace pos::app
