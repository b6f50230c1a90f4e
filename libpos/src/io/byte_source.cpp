#include "byte_source.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "pos/core/error.hpp"

namespace pos::io {
namespace {

/// When compressed data turns out to be corrupt, zlib loses what it had unpacked of the same block: keep it
/// small.
constexpr std::size_t kBlock = std::size_t{1} << 15U;

gzFile opened(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw DataError(Complaint{.what = "there is no such file",
                              .place = {.file = path},
                              .suggestion = "check the path and its spelling"});
  }
  if (std::filesystem::is_directory(status)) {
    throw DataError(Complaint{.what = "this is a folder, not a file",
                              .place = {.file = path},
                              .suggestion = "name one file inside the folder"});
  }
  gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) {
    throw DataError(Complaint{.what = "the file cannot be opened for reading",
                              .place = {.file = path},
                              .suggestion = "check that you may read it"});
  }
  gzbuffer(file, kBlock / 2);  // zlib then unpacks whole blocks straight into ours
  return file;
}

std::string reasonOf(gzFile file) {
  int code = Z_OK;
  const std::string text = gzerror(file, &code);
  if (code == Z_BUF_ERROR) return "the compressed file is cut short";
  return "the compressed data is corrupt (" + text.substr(text.rfind(": ") + 1) + ")";
}

}  // namespace

ByteSource::ByteSource(const std::string& path) : file_(opened(path)), buffer_(2 * kBlock) {}

std::size_t ByteSource::take(void* target, std::size_t count) {
  if (count > 0) std::memcpy(target, buffer_.data() + begin_, count);
  begin_ += count;
  position_ += count;
  return count;
}

std::size_t ByteSource::readSlowly(void* target, std::size_t count) {
  auto* out = static_cast<std::uint8_t*>(target);
  std::size_t done = 0;
  while (done < count) {
    const std::size_t available = std::min(count - done, peek(1).empty() ? 0 : end_ - begin_);
    if (available == 0) break;
    done += take(out + done, available);
  }
  return done;
}

void ByteSource::fill(std::size_t wanted) {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
            buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
  end_ -= begin_;
  begin_ = 0;
  while (!exhausted_ && end_ < wanted) {
    if (buffer_.size() - end_ < kBlock) buffer_.resize(buffer_.size() + std::max(kBlock, buffer_.size()));
    const int got = gzread(file_.get(), buffer_.data() + end_, kBlock);
    if (got > 0) end_ += static_cast<std::size_t>(got);
    if (got < static_cast<int>(kBlock)) {
      exhausted_ = true;
      int code = Z_OK;
      gzerror(file_.get(), &code);
      if (got < 0 || code != Z_OK) damage_ = reasonOf(file_.get());
    }
  }
}

}  // namespace pos::io
