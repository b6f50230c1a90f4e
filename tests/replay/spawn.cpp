#include "replay/spawn.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>

namespace pos::replay {
namespace {

namespace fs = std::filesystem;

/// Only what the command may depend on; sanitizers and coverage counters keep their settings. Counters
/// without a place of their own would be written into the folder of the test.
std::vector<std::string> bareEnvironment() {
  std::vector<std::string> environment{"PATH=/usr/bin:/bin", "LC_ALL=C.UTF-8"};
  for (const char* name : {"POS_MRPT_SHARE", "ASAN_OPTIONS", "LSAN_OPTIONS", "UBSAN_OPTIONS"}) {
    if (const char* value = std::getenv(name)) environment.push_back(std::string(name) + "=" + value);
  }
  const char* counters = std::getenv("LLVM_PROFILE_FILE");
  environment.push_back(std::string("LLVM_PROFILE_FILE=") + (counters != nullptr ? counters : "/dev/null"));
  return environment;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> all;
  for (std::string& word : words) all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

}  // namespace

Streams::Streams(const fs::path& folder, const fs::path& out, const fs::path& err, int input) {
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_init(&actions_);
  posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
  if (input < 0) posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
  if (input >= 0) posix_spawn_file_actions_adddup2(&actions_, input, 0);
  posix_spawn_file_actions_addopen(&actions_, 1, out.c_str(), flags, 0644);
  posix_spawn_file_actions_addopen(&actions_, 2, err.c_str(), flags, 0644);
}

Streams::~Streams() {
  posix_spawn_file_actions_destroy(&actions_);
}

int exitCodeOf(pid_t child) {
  int status = 0;
  if (waitpid(child, &status, 0) != child) throw std::runtime_error("waitpid failed");
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

pid_t spawned(const std::vector<std::string>& arguments, const Streams& streams) {
  std::vector<std::string> words{POS_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> environment = bareEnvironment();
  pid_t child = 0;
  const int failed = posix_spawn(&child, POS_BINARY, streams.get(), nullptr, pointers(words).data(),
                                 pointers(environment).data());
  if (failed != 0) throw std::runtime_error(std::string("cannot start ") + POS_BINARY);
  return child;
}

}  // namespace pos::replay
