#pragma once
/// Starting the built command `pos`. For run_pos.cpp and running_pos.cpp.

#include <spawn.h>
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pos::replay {

/// Where the child's streams go, and where it starts.
class Streams {
 public:
  /// `input` is a descriptor of ours, or -1 for no input.
  Streams(const std::filesystem::path& folder, const std::filesystem::path& out,
          const std::filesystem::path& err, int input = -1);
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;
  Streams(Streams&&) = delete;
  Streams& operator=(Streams&&) = delete;
  ~Streams();
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// Without a shell and with a bare environment.
pid_t spawned(const std::vector<std::string>& arguments, const Streams& streams);
/// Waits for its end; -1 when a signal ended it.
int exitCodeOf(pid_t child);

}  // namespace pos::replay
