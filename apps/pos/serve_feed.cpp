#include "serve_feed.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

#include "pos/core/error.hpp"
#include "pos/io/json_lines.hpp"

namespace pos::app {
namespace {

constexpr int kLookEvery = 100;  // ms, whether to stop
constexpr int kMostSenders = 16;

/// Closes a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int file) : file_(file) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor(Descriptor&&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() { ::close(file_); }

 private:
  int file_;
};

bool readable(int file) {
  pollfd wait{.fd = file, .events = POLLIN, .revents = 0};
  return ::poll(&wait, 1, kLookEvery) > 0;
}

[[noreturn]] void refusePort(const std::string& address, int port) {
  throw UsageError(Complaint{.what = "this port cannot be listened at",
                             .key = "--live-tcp",
                             .got = address + ":" + std::to_string(port),
                             .suggestion = "another program may have it: try another port, or 0 for any"});
}

}  // namespace

Feed::~Feed() {
  stopping_ = true;
  for (std::thread& thread : threads_) thread.join();
  while (senders_ > 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

void Feed::readFrom(int file, const std::string& source) {
  io::LineCutter cutter;
  const auto take = [&](const io::LineCutter::Line& line) {
    try {
      if (line.too_long) throw DataError("the line is longer than 1 MiB");
      ears_.measurement(io::measurementFrom(line.text, source, line.number));
    } catch (const Error& error) {
      const Complaint& complaint = error.complaint();
      ears_.bad_line("line " + std::to_string(line.number) + " of " + source + ": " + complaint.what +
                         (complaint.key.empty() ? "" : ", " + complaint.key) +
                         (complaint.got.empty() ? "" : ", got " + complaint.got.substr(0, 80)),
                     line.too_long ? "" : io::sensorNamedBy(line.text));
    }
  };
  std::vector<char> buffer(1U << 16);
  while (!stopping_) {
    if (!readable(file)) continue;
    const ssize_t count = ::read(file, buffer.data(), buffer.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count <= 0) break;
    cutter.feed({buffer.data(), static_cast<std::size_t>(count)}, take);
  }
  if (!stopping_) cutter.finish(take);
}

void Feed::readStandardInput() {
  threads_.emplace_back([this] {
    readFrom(STDIN_FILENO, "standard input");
    ears_.ended();
  });
}

void Feed::accept(int socket) {
  const Descriptor listening(socket);
  for (int number = 1; !stopping_;) {
    if (!readable(socket)) continue;
    const int connection = ::accept(socket, nullptr, nullptr);
    if (connection < 0) continue;
    if (senders_ >= kMostSenders) {
      ::close(connection);
      ears_.bad_line("line 0: a sender was turned away, " + std::to_string(kMostSenders) + " are connected",
                     "");
      continue;
    }
    ++senders_;
    std::thread([this, connection, number] {
      {
        const Descriptor closing(connection);
        readFrom(connection, "sender " + std::to_string(number));
      }
      --senders_;  // the last touch of this object
    }).detach();
    ++number;
  }
}

int Feed::listen(const std::string& address, int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (socket < 0) refusePort(address, port);
  const int on = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof place;
  const bool good = ::inet_pton(AF_INET, address.c_str(), &place.sin_addr) == 1 &&
                    ::bind(socket, reinterpret_cast<const sockaddr*>(&place), size) == 0 &&
                    ::listen(socket, kMostSenders) == 0 &&
                    ::getsockname(socket, reinterpret_cast<sockaddr*>(&place), &size) == 0;
  if (!good) {
    ::close(socket);
    refusePort(address, port);
  }
  threads_.emplace_back([this, socket] { accept(socket); });
  return ntohs(place.sin_port);
}

}  // namespace pos::app
