#pragma once
/// The uncompressed bytes of a file, plain or gzip, with look-ahead. Private to io.

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pos::io {

/// Reads a file from front to back in constant memory.
class ByteSource {
 public:
  /// Throws DataError when the file is missing, a folder, or cannot be opened.
  explicit ByteSource(const std::string& path);

  /// Copies up to `count` bytes to `target`; fewer only at the end of the readable part.
  std::size_t read(void* target, std::size_t count) {
    if (count <= end_ - begin_) return take(target, count);
    return readSlowly(target, count);
  }
  /// The next bytes without consuming them: `count` of them, or fewer at the end of the readable part.
  std::span<const std::uint8_t> peek(std::size_t count) {
    if (count > end_ - begin_) fill(count);
    return {buffer_.data() + begin_, std::min(count, end_ - begin_)};
  }
  /// Consumes `count` bytes that were seen by peek.
  void skip(std::size_t count) {
    begin_ += count;
    position_ += count;
  }
  /// True when nothing more can be read.
  bool atEnd() { return peek(1).empty(); }
  /// Bytes consumed so far, counted in the uncompressed stream.
  std::uint64_t position() const { return position_; }
  /// Why the compressed file ended early, or nothing.
  const std::optional<std::string>& damage() const { return damage_; }

 private:
  struct Closer {
    void operator()(gzFile file) const { gzclose_r(file); }
  };

  std::size_t take(void* target, std::size_t count);
  std::size_t readSlowly(void* target, std::size_t count);
  void fill(std::size_t wanted);

  std::unique_ptr<gzFile_s, Closer> file_;
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t position_ = 0;
  bool exhausted_ = false;
  std::optional<std::string> damage_;
};

}  // namespace pos::io
