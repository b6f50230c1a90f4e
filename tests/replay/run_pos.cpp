#include "replay/run_pos.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace pos::replay {
namespace {

namespace fs = std::filesystem;

/// Only what the command may depend on; sanitizers keep their settings.
std::vector<std::string> bareEnvironment() {
  std::vector<std::string> environment{"PATH=/usr/bin:/bin", "LC_ALL=C.UTF-8"};
  for (const char* name : {"POS_MRPT_SHARE", "ASAN_OPTIONS", "LSAN_OPTIONS", "UBSAN_OPTIONS"}) {
    if (const char* value = std::getenv(name)) environment.push_back(std::string(name) + "=" + value);
  }
  return environment;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> all;
  for (std::string& word : words) all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

/// Where the child's streams go, and where it starts.
class Streams {
 public:
  /// `input` is a descriptor of ours, or -1 for no input.
  Streams(const fs::path& folder, const fs::path& out, const fs::path& err, int input = -1) {
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
    if (input < 0) posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
    if (input >= 0) posix_spawn_file_actions_adddup2(&actions_, input, 0);
    posix_spawn_file_actions_addopen(&actions_, 1, out.c_str(), flags, 0644);
    posix_spawn_file_actions_addopen(&actions_, 2, err.c_str(), flags, 0644);
  }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;
  Streams(Streams&&) = delete;
  Streams& operator=(Streams&&) = delete;
  ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

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

}  // namespace

int RunResult::errLines() const {
  return static_cast<int>(std::count(err.begin(), err.end(), '\n'));
}

Bench::Bench() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  folder_ = fs::path(POS_BINARY).parent_path().parent_path() / "replay_tests" /
            (std::string(test->test_suite_name()) + "_" + test->name());
  fs::remove_all(folder_);
  fs::create_directories(folder_);
}

Bench::~Bench() {
  std::error_code ignored;
  if (!::testing::Test::HasFailure()) fs::remove_all(folder_, ignored);
}

RunResult Bench::pos(const std::vector<std::string>& arguments) const {
  const fs::path out = folder_.string() + ".stdout";
  const fs::path err = folder_.string() + ".stderr";
  RunResult result;
  result.exit_code = exitCodeOf(spawned(arguments, Streams(folder_, out, err)));
  result.out = contents(out);
  result.err = contents(err);
  fs::remove(out);
  fs::remove(err);
  return result;
}

RunResult Bench::posStopped(const std::vector<std::string>& arguments, const std::string& words,
                            int signal) const {
  const fs::path pipe = folder_.string() + ".pipe";
  fs::remove(pipe);
  if (mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("mkfifo failed");
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);  // first, or the child would wait for it
  const pid_t child = spawned(arguments, Streams(folder_, "/dev/null", pipe));
  fcntl(reader, F_SETFL, 0);
  RunResult result;
  bool sent = false;
  std::array<char, 4096> block{};
  for (ssize_t n = 0; (n = ::read(reader, block.data(), block.size())) > 0;) {
    result.err.append(block.data(), static_cast<std::size_t>(n));
    if (sent || result.err.find(words) == std::string::npos) continue;
    ::kill(child, signal);
    sent = true;
  }
  ::close(reader);
  fs::remove(pipe);
  result.exit_code = exitCodeOf(child);
  return result;
}

void Bench::write(const std::string& name, const std::string& text) const {
  fs::create_directories((folder_ / name).parent_path());
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::string Bench::read(const std::string& name) const {
  return contents(folder_ / name);
}

Running::Running(const Bench& bench, const std::vector<std::string>& arguments)
    : out_(bench.folder() / "running.stdout"), err_(bench.folder() / "running.stderr") {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe failed");
  child_ = spawned(arguments, Streams(bench.folder(), out_, err_, ends[0]));
  ::close(ends[0]);
  input_ = ends[1];
}

Running::~Running() {
  closeInput();
  if (child_ == 0) return;
  ::kill(child_, SIGKILL);
  (void)exitCodeOf(child_);
}

int Running::numberAfter(const std::string& words) const {
  for (int i = 0; i < 6000; ++i) {
    const std::string text = out() + err();
    const std::size_t at = text.find(words);
    const std::size_t end =
        at == std::string::npos ? at : text.find_first_not_of("0123456789", at + words.size());
    if (end != std::string::npos && end > at + words.size()) return std::stoi(text.substr(at + words.size()));
    siginfo_t ended{};
    if (waitid(P_PID, static_cast<id_t>(child_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
        ended.si_pid != 0)
      break;
    usleep(10'000);
  }
  throw std::runtime_error("pos did not say '" + words + "': " + err());
}

std::string Running::out() const {
  return contents(out_);
}
std::string Running::err() const {
  return contents(err_);
}

void Running::feed(const std::string& text) const {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = ::write(input_, text.data() + done, text.size() - done);
    if (n <= 0) throw std::runtime_error("pos takes no more input");
    done += static_cast<std::size_t>(n);
  }
}

void Running::closeInput() {
  if (input_ >= 0) ::close(input_);
  input_ = -1;
}

void Running::signal(int number) const {
  ::kill(child_, number);
}

int Running::wait() {
  const int code = exitCodeOf(child_);
  child_ = 0;
  return code;
}

std::size_t Running::memory() const {
  std::ifstream file("/proc/" + std::to_string(child_) + "/statm");
  std::size_t total = 0;
  std::size_t resident = 0;
  file >> total >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::string contents(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

fs::path source(const std::string& relative) {
  return fs::path(POS_SOURCE_DIR) / relative;
}

fs::path datasets() {
  const char* share = std::getenv("POS_MRPT_SHARE");
  const fs::path folder = fs::path(share != nullptr ? share : "/usr/share/mrpt") / "datasets";
  return fs::exists(folder / "uwb_ro-localization_demo.rawlog") ? folder : fs::path{};
}

fs::path recordings() {
  const char* named = std::getenv("POS_DATA_DIR");
  const fs::path folder = named != nullptr ? fs::path(named) : source("../shared/data").lexically_normal();
  return fs::exists(folder / "plaza1") ? folder : fs::path{};
}

}  // namespace pos::replay
