#pragma once
/// A file that only grows, so that a killed program loses at most what came since the last flush.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace pos::io {

class AppendFile {
 public:
  /// Makes a new file. Throws DataError when it exists already or cannot be made.
  explicit AppendFile(const std::filesystem::path& path);
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;
  AppendFile(AppendFile&&) = delete;
  AppendFile& operator=(AppendFile&&) = delete;
  /// Writes what is left, without a word when the disk is full: close() tells.
  ~AppendFile();

  void append(std::string_view bytes) { waiting_ += bytes; }
  /// Everything appended so far goes to the disk, whole. Throws DataError when that fails.
  void flush();
  void close();

  std::uint64_t bytes() const { return written_ + waiting_.size(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  bool put();

  std::filesystem::path path_;
  int file_ = -1;
  std::string waiting_;
  std::uint64_t written_ = 0;
};

}  // namespace pos::io
