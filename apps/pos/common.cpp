#include "common.hpp"

#include <cstdlib>
#include <fstream>
#include <iostream>

#include "pos/core/error.hpp"

namespace pos::app {

void Voice::say(const std::string& text) const {
  if (!quiet) std::cerr << text << "\n";
}

void Voice::detail(const std::string& text) const {
  if (verbose && !quiet) std::cerr << text << "\n";
}

void Voice::warn(const std::string& text) const {
  std::cerr << "warning: " << text << "\n";
}

void addVoice(CLI::App& verb, Voice& voice) {
  verb.add_flag("-q,--quiet", voice.quiet, "Only errors and warnings on standard error");
  verb.add_flag("-v,--verbose", voice.verbose, "More about what is going on");
}

void print(const std::string& text) {
  std::cout << text;
}

void flushOutput() {
  std::cout.flush();
}

void writeFile(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    throw DataError(
        Complaint{.what = "the file cannot be written",
                  .place = {.file = path.string()},
                  .suggestion = "check that the folder exists, may be written to and has space left"});
  }
}

std::filesystem::path mrptShare() {
  const char* share = std::getenv("POS_MRPT_SHARE");
  return share != nullptr ? std::filesystem::path(share) : std::filesystem::path("/usr/share/mrpt");
}

std::string version() {
  return POS_VERSION;
}
std::string gitHash() {
  const std::string hash = POS_GIT_HASH;
  return hash.empty() ? "no revision" : hash;
}

}  // namespace pos::app
