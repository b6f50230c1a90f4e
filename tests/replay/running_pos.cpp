#include "replay/running_pos.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <stdexcept>

#include "replay/spawn.hpp"

namespace pos::replay {

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

}  // namespace pos::replay
