#include "bench_programs.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "pos/core/error.hpp"

namespace pos::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& program, const std::string& got) {
  throw DataError(Complaint{.what = "a benchmark program failed",
                            .place = {.file = program.string()},
                            .got = got,
                            .suggestion = "run it by itself to see what it says"});
}

/// Starts the program with `out` as its standard output; -1 where that is not possible.
pid_t started(const fs::path& program, const std::vector<std::string>& arguments, int out) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t streams{};
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_addopen(&streams, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&streams, out, 1);
  posix_spawn_file_actions_addopen(&streams, 2, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawn(&child, program.c_str(), &streams, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  return failed == 0 ? child : -1;
}

}  // namespace

std::vector<std::string> benchPrograms(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("bench_") && entry.is_regular_file() && !entry.path().has_extension())
      names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

fs::path benchFolder(const std::string& named) {
  std::error_code failed;
  const fs::path own = fs::read_symlink("/proc/self/exe", failed).parent_path();
  const auto places = named.empty() ? std::vector<fs::path>{own, (own / "../libexec/pos").lexically_normal()}
                                    : std::vector<fs::path>{named};
  for (const fs::path& folder : places) {
    if (!benchPrograms(folder).empty()) return folder;
  }
  throw UsageError(Complaint{.what = "there are no benchmark programs",
                             .key = "--programs",
                             .got = places.front().string(),
                             .expected = "a folder with programs bench_*",
                             .suggestion = "scripts/build release --target bench"});
}

std::string outputOf(const fs::path& program, const std::vector<std::string>& arguments) {
  std::array<int, 2> pipe{};
  if (pipe2(pipe.data(), O_CLOEXEC) != 0) refuse(program, "no pipe could be made");
  const pid_t child = started(program, arguments, pipe[1]);
  ::close(pipe[1]);
  std::string text;
  std::array<char, 65536> block{};
  for (ssize_t n = 0; child > 0 && (n = ::read(pipe[0], block.data(), block.size())) > 0;)
    text.append(block.data(), static_cast<std::size_t>(n));
  ::close(pipe[0]);
  if (child < 0) refuse(program, "it cannot be started");
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) refuse(program, "it was ended by a signal");
  if (WEXITSTATUS(status) != 0) refuse(program, "exit code " + std::to_string(WEXITSTATUS(status)));
  return text;
}

}  // namespace pos::app
