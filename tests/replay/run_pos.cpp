#include "replay/run_pos.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "replay/spawn.hpp"

namespace pos::replay {
namespace fs = std::filesystem;

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
