#include "pos/io/append_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "pos/core/error.hpp"

namespace pos::io {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::filesystem::path& path, int error) {
  throw DataError(
      Complaint{.what = what,
                .place = {.file = path.string()},
                .got = std::strerror(error),
                .suggestion = "check that the folder exists, may be written to and has space left"});
}

}  // namespace

AppendFile::AppendFile(const std::filesystem::path& path)
    : path_(path), file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644)) {
  if (file_ < 0) refuse("the recording cannot be begun", path_, errno);
}

AppendFile::~AppendFile() {
  if (file_ < 0) return;
  (void)put();
  ::close(file_);
}

bool AppendFile::put() {
  while (!waiting_.empty()) {
    const ssize_t count = ::write(file_, waiting_.data(), waiting_.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    written_ += static_cast<std::uint64_t>(count);
    waiting_.erase(0, static_cast<std::size_t>(count));
  }
  return true;
}

void AppendFile::flush() {
  if (file_ < 0 || waiting_.empty()) return;
  if (!put() || ::fdatasync(file_) != 0) refuse("the recording cannot be continued", path_, errno);
}

void AppendFile::close() {
  flush();
  if (file_ < 0) return;
  if (::close(std::exchange(file_, -1)) != 0)
    refuse("the recording was not written to its end", path_, errno);
}

}  // namespace pos::io
