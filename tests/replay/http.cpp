#include "replay/http.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace pos::replay {
namespace {

int connected(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
    ::close(socket);
    throw std::runtime_error("nobody answers at port " + std::to_string(port));
  }
  return socket;
}

/// False when the other side has closed.
bool sendAll(int socket, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::send(socket, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

HttpAnswer parsed(const std::string& text) {
  HttpAnswer answer;
  const std::size_t end = text.find("\r\n\r\n");
  if (end == std::string::npos || !text.starts_with("HTTP/1.1 ")) return answer;
  answer.status = std::stoi(text.substr(9, 3));
  std::istringstream lines(text.substr(0, end));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    std::string name = line.substr(0, colon);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    answer.headers[name] = line.substr(colon + 2, line.find('\r') - colon - 2);
  }
  answer.body = text.substr(end + 4);
  return answer;
}

}  // namespace

std::string exchanged(int port, const std::string& bytes) {
  const int socket = connected(port);
  (void)sendAll(socket, bytes);  // a server may refuse before it has read everything
  std::string text;
  std::array<char, 65536> block{};
  pollfd wait{.fd = socket, .events = POLLIN, .revents = 0};
  while (::poll(&wait, 1, 20'000) > 0) {
    const ssize_t n = ::recv(socket, block.data(), block.size(), 0);
    if (n <= 0) break;
    text.append(block.data(), static_cast<std::size_t>(n));
  }
  ::close(socket);
  return text;
}

HttpAnswer get(int port, const std::string& target, const std::string& headers) {
  return parsed(exchanged(
      port, "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n" + headers + "\r\n"));
}

HttpAnswer send(int port, const std::string& method, const std::string& target, const std::string& body,
                const std::string& headers) {
  return parsed(exchanged(port, method + " " + target +
                                    " HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n" + headers +
                                    "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body));
}

EventStream::EventStream(int port) : socket_(connected(port)) {
  (void)sendAll(socket_, "GET /api/stream HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
}

EventStream::EventStream(EventStream&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), buffer_(std::move(other.buffer_)) {}

EventStream::~EventStream() {
  if (socket_ >= 0) ::close(socket_);
}

bool EventStream::receive(int timeout_ms) {
  std::array<char, 65536> block{};
  pollfd wait{.fd = socket_, .events = POLLIN, .revents = 0};
  if (::poll(&wait, 1, timeout_ms) <= 0) return false;
  const ssize_t n = ::recv(socket_, block.data(), block.size(), 0);
  if (n <= 0) return false;
  buffer_.append(block.data(), static_cast<std::size_t>(n));
  return true;
}

std::string EventStream::next(const std::string& name, int timeout_ms) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::milliseconds(timeout_ms);
  const std::string head = "event: " + name + "\ndata: ";
  for (;;) {
    const std::size_t at = buffer_.find(head);
    const std::size_t stop = at == std::string::npos ? at : buffer_.find("\n\n", at);
    if (stop != std::string::npos) {
      std::string data = buffer_.substr(at + head.size(), stop - at - head.size());
      buffer_.erase(0, stop + 2);
      return data;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0 || !receive(static_cast<int>(left))) return {};
  }
}

EventStream::Arrived EventStream::arrived() {
  while (receive(0)) continue;
  const std::size_t end = buffer_.rfind("\n\n");
  if (end == std::string::npos) return {};
  const std::string whole = buffer_.substr(0, end + 2);
  buffer_.erase(0, end + 2);
  const auto count = [&](const std::string& head) {
    int n = 0;
    for (std::size_t at = whole.find(head); at != std::string::npos; at = whole.find(head, at + 1)) ++n;
    return n;
  };
  return {count("event: heartbeat\n"), count("event: state\n")};
}

Sender::Sender(int port) : socket_(connected(port)) {}

Sender::~Sender() {
  ::close(socket_);
}

void Sender::send(const std::string& text) const {
  if (!sendAll(socket_, text)) throw std::runtime_error("the live feed is closed");
}

}  // namespace pos::replay
